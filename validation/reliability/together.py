"""Two and three generators at once in one directory: one makes the set, the others are told so."""

from __future__ import annotations

import json
import time

import numpy as np

from validation.reliability.processes import Process
from validation.reliability.rows import Row, timed
from validation.reliability.sets import RUNS, Truth

WRITING = "another rubgen is writing there"


def together_row(truth: Truth, count: int, tries: int) -> Row:
    """`count` of them, started within a generation's time; in every second try at the same moment."""
    row = Row(f"{count} generators in one directory")
    generator = np.random.default_rng(count)
    with timed(row):
        for number in range(tries):
            row.tries += 1
            out = truth.new_directory()
            pauses = generator.random(count - 1) * truth.seconds[1] * (number % 2) / count
            processes = [truth.generate(out, log="generator-0")]
            for rank, pause in enumerate(pauses.tolist(), 1):
                time.sleep(pause)
                processes.append(truth.generate(out, log=f"generator-{rank}"))
            _check(processes, row, f"try {number}, pauses {pauses.round(3).tolist()} s")
            truth.complete(out, row, f"try {number}")
    return row


def _check(processes: list[Process], row: Row, what: str) -> None:
    makers = 0
    for process in processes:
        code = process.end()
        if code == 0:
            makers += json.loads(process.output)["made"] == RUNS
        elif code != 2 or len(process.lines) != 1 or WRITING not in process.output:
            row.fail("tracebacks", f"{what}: {code}: {process.output.strip()[-300:]}")
    if makers != 1:
        row.fail("lost", f"{what}: {makers} made the set")
