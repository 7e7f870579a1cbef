"""What labels, sensors and the exponent cost beside the solver: CPU times of runs of 600 turns, one thread.

100 turns settle, 500 are recorded, 1 s of eleven channels at 25.6 kHz; a light rub that repeats and one that does not.
Medians of several rounds.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks.cpu_time import median_time
from benchmarks.rows import rows_of
from rubgen import make_scenario
from rubgen.labels import label
from rubgen.measurement import margin_seconds
from rubgen.measurement import measure as record
from rubgen.reduction import reduce
from rubgen.scenario import Scenario
from rubgen.solver import Response
from rubgen.solver.integrate import integrate
from rubgen.solver.wants import Wants

ROUNDS = 5
RUNS = {
    "period-1": {"speed_rpm": 10000.0, "disk_support_stiffness_n_per_m": 2e8},
    "chaotic": {"speed_rpm": 6900.0},
}


def run(scenario: Scenario, *, companion: bool) -> Response:
    """The response as `simulate` asks for it."""
    sensing = scenario.sensing
    model = reduce(scenario.machine, scenario.reduction)
    return integrate(
        model,
        scenario.operation,
        scenario.contact,
        Wants(
            tail_seconds=scenario.signal_seconds + margin_seconds(sensing, scenario.signal_seconds),
            sample_rate_hz=sensing.fastest_hz,
            taps=sensing.set.taps,
            companion=companion,
        ),
    )


def measure_run(name: str, keys: dict[str, float]) -> list[dict[str, object]]:
    """Rows of one run."""
    scenario = make_scenario("zeng2019", **keys)
    scenario = replace(scenario, operation=replace(scenario.operation, settle_turns=100, record_turns=500))
    with threadpool_limits(1):
        response = run(scenario, companion=True)  # loads the kernels
        median = partial(median_time, rounds=ROUNDS)
        plain = median(lambda: run(scenario, companion=False))
        beside = median(lambda: run(scenario, companion=True))
        labels = median(lambda: label(response))
        seconds, rng = scenario.signal_seconds, np.random.default_rng(0)
        sensors = median(lambda: record(response, scenario.sensing, seconds=seconds, rng=rng))
    rows = (
        ("solver, 600 turns without exponent, CPU", plain, "s", "recorded"),
        ("labels, CPU", 1e3 * labels, "ms", "recorded"),
        ("sensors, CPU", 1e3 * sensors, "ms", "recorded"),
        ("labels and sensors, CPU a run", 1e3 * (labels + sensors), "ms", "<= 60"),
        (
            "a run with the exponent over one without",
            (beside + labels + sensors) / (plain + labels + sensors),
            "1",
            "<= 2",
        ),
    )
    return rows_of(rows, f"{name}: ")


def measure() -> list[dict[str, object]]:
    return [row for name, keys in RUNS.items() for row in measure_run(name, keys)]
