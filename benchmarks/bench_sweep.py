"""The paper's sweep as throughput: 105 speeds (2,460 .. 14,940 rev/min) of the preset for 150 turns each.

Transients included (100 turns to settle, 50 recorded), no labels, no exponent, two processes as studies have them, with
warm caches; start of the processes included. The CPU time says what an idle machine would take where others work too.
"""

from __future__ import annotations

import resource
import time
from dataclasses import replace

from benchmarks.rows import rows_of
from rubgen import make_scenario
from rubgen.dataset.making.workers import unordered, worker_pool
from validation.sensitivity.halving import SPEEDS_RPM

SETTLE_TURNS, RECORD_TURNS, WORKERS = 100, 50, 2


def run(speed_rpm: float) -> tuple[float, int]:
    """CPU seconds of one run and its steps in contact."""
    from rubgen.reduction import reduce
    from rubgen.solver import Status
    from rubgen.solver.integrate import integrate

    begun = time.process_time()
    scenario = make_scenario("zeng2019", speed_rpm=speed_rpm)
    operation = replace(scenario.operation, settle_turns=SETTLE_TURNS, record_turns=RECORD_TURNS)
    system = reduce(scenario.machine, scenario.reduction).at_speed(operation.speed_rad_per_s)
    response = integrate(system, operation, scenario.contact)
    if response.status is not Status.OK:
        raise RuntimeError(f"{speed_rpm:g} rev/min: {response.reason}")
    return time.process_time() - begun, int(response.contact_steps_per_turn.sum())


def measure() -> list[dict[str, object]]:
    run(SPEEDS_RPM[0])  # compiles, and fills the cache of machines
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begun = time.perf_counter()
    with worker_pool(WORKERS) as pool:
        done = list(unordered(pool, run, ((speed,) for speed in SPEEDS_RPM)))
        seconds = time.perf_counter() - begun
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    rubbing = sum(contact > 0 for _, contact in done)
    rows = (
        ("sweep of 105 speeds x 150 turns, two workers", seconds, "s", "<= 30, goal 15"),
        ("sweep: CPU time of both workers / 2", spent / WORKERS, "s", "recorded"),
        ("sweep: speeds that rub", rubbing, "runs", "recorded"),
    )
    return rows_of(rows)
