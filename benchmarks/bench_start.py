"""Start-up: the command line beside a bare interpreter, and a worker up to its first turn, as whole processes.

Median of several. The worker imports, loads kernels and machine from warm caches, and runs one turn of contact.
"""

from __future__ import annotations

import os
import resource
import statistics
import subprocess
import sys
import time
from pathlib import Path

WORKERS = 5
ONE_THREAD = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
WORKER = """
from rubgen import make_scenario
from rubgen.reduction import reduce
from rubgen.measurement import measure
from rubgen.labels import label
from rubgen.solver.speed.start import rub_free_stepper
scenario = make_scenario("zeng2019")
system = reduce(scenario.machine, scenario.reduction).at_speed(scenario.operation.speed_rad_per_s)
rub_free_stepper(system, scenario.contact, scenario.operation.steps_per_turn).run_turn()
"""
HELP = [str(Path(sys.executable).with_name("rubgen")), "--help"]


def measure() -> list[dict[str, object]]:
    bare = _median_seconds([sys.executable, "-c", "pass"])
    help_ = _median_seconds(HELP)
    worker = [sys.executable, "-c", WORKER]
    _median_seconds(worker, repeats=1)  # fills the caches
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    started = _median_seconds(worker, repeats=WORKERS)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return [
        {"name": "rubgen --help", "value": help_, "unit": "s", "target": "<= 0.3"},
        {"name": "rubgen --help over a bare interpreter", "value": help_ / bare, "unit": "ratio", "target": "recorded"},
        {"name": "worker up to its first turn, warm caches", "value": started, "unit": "s", "target": "<= 2"},
        {"name": "worker up to its first turn, CPU", "value": spent / WORKERS, "unit": "s", "target": "recorded"},
    ]


def _median_seconds(command: list[str], repeats: int = 9) -> float:
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True, env=ONE_THREAD)
        times.append(time.perf_counter() - start)
    return statistics.median(times)
