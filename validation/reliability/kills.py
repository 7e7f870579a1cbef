"""Signals at random moments of a generation; the same command must complete it to the same bytes."""

from __future__ import annotations

import signal
import time
from pathlib import Path

import numpy as np

from validation.reliability.rows import Row, timed
from validation.reliability.sets import Truth, digests, kept_runs

STOPS_IN_A_ROW = 4
"""So many stops hit a set before it is completed."""
EARLY_SHARE = 0.2
"""So many of the moments lie in the first twentieth: there a directory is claimed."""
FRESH_EVERY = 5
"""Every so many starts is a new interpreter, whose imports are interrupted too."""


def signal_row(truth: Truth, name: str, workers: int, tries: int) -> Row:
    """SIGKILL, SIGINT or SIGTERM, at random moments."""
    row = Row(f"{name} at a random moment, {workers} worker{'s' if workers > 1 else ''}")
    generator = np.random.default_rng([workers, *name.encode()])
    with timed(row):
        if workers not in truth.seconds:
            truth.seconds[workers] = _seconds(truth, workers)
        while row.tries < tries:
            _one_set(truth, row, signal.Signals[name], workers, generator, min(STOPS_IN_A_ROW, tries - row.tries))
    return row


def _seconds(truth: Truth, workers: int) -> float:
    begun, out = time.monotonic(), truth.new_directory()
    truth.complete(out, Row("undisturbed"), "undisturbed", workers=workers, fresh=True)
    return time.monotonic() - begun


def _one_set(
    truth: Truth, row: Row, number: signal.Signals, workers: int, generator: np.random.Generator, stops: int
) -> None:
    out = truth.new_directory()
    kept: dict[str, tuple[int, int]] = {}
    moments = []
    for _ in range(stops):
        moment = truth.seconds[workers] * (0.05 if generator.random() < EARLY_SHARE else 1.0) * generator.random()
        moments.append(f"{moment:.3f}")
        what = f"{number.name}, {workers} workers, after {', '.join(moments)} s"
        row.tries += 1
        process = truth.generate(out, workers=workers, fresh=workers > 1 or row.tries % FRESH_EVERY == 0)
        if not process.ends_within(moment):
            process.send(number)
        _check_end(process.end(), process.output, number, row, what)
        now = kept_runs(out)
        _check_kept(kept, now, out, row, what)
        kept |= now
    truth.complete(out, row, what, workers=workers, fresh=workers > 1)


def _check_end(code: int, output: str, number: signal.Signals, row: Row, what: str) -> None:
    if "Traceback" in output:
        row.fail("tracebacks", f"{what}: {output.strip()[-300:]}")
    elif code not in (0, 130, -number):
        row.fail("lost", f"{what}: ended with {code}: {output.strip()[-300:]}")


def _check_kept(
    before: dict[str, tuple[int, int]], now: dict[str, tuple[int, int]], out: Path, row: Row, what: str
) -> None:
    if not now and digests(out).keys() >= {"manifest.json.sha256"}:
        return
    for name in sorted(name for name, facts in before.items() if now.get(name) != facts):
        row.fail("lost", f"{what}: {name} was kept and is made again")
