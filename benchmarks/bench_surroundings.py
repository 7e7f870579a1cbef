"""What surroundings cost in a run: the first runs of `field`, each measured in the plant and in silence, in turn.

The motion does not know of the surroundings, so it is integrated once. The time of the run is that of `simulate` with
all labels. Reduced machines are in the cache.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from threadpoolctl import threadpool_limits

import rubgen
from benchmarks.cpu_time import cpu_time
from rubgen import measurement
from rubgen.pipeline import Run
from rubgen.scenario import Scenario, load_recipe

RUNS, ROUNDS = 12, 7


def measure_times(run: Run) -> tuple[float, float]:
    """Median CPU time in s of the recording in the plant and in silence, in alternating rounds."""
    scenario: Scenario = run.scenario
    machine, times = scenario.machine, dict[bool, list[float]]({True: [], False: []})
    for number in range(2 * ROUNDS):
        plant = number % 2 == 0
        work = partial(
            measurement.measure, run.response, scenario.sensing, seconds=scenario.signal_seconds,
            rng=np.random.default_rng(0), surroundings=scenario.surroundings if plant else None, frame=scenario.frame,
            faults=machine.faults,
        )  # fmt: skip
        times[plant].append(cpu_time(work))
    return float(np.median(times[True])), float(np.median(times[False]))


def measure_all() -> list[tuple[bool, float, float]]:
    """Whether each run rubs, its CPU time without surroundings in s, and what they add."""
    recipe, found = load_recipe("field"), []
    for index in range(RUNS):
        scenario = recipe.scenario(index)
        rubgen.simulate(scenario)  # kernels and reduced machine
        made: list[Run] = []
        whole = cpu_time(lambda: made.append(rubgen.simulate(scenario)))  # noqa: B023
        if made[0].labels is None:
            continue
        plant, silence = measure_times(made[0])
        found.append((bool(made[0].labels.rub), whole - plant + silence, plant - silence))
    return found


def measure_rows(found: list[tuple[bool, float, float]]) -> list[dict[str, object]]:
    """One row for all runs, one for those that rub, one for the others."""
    parts = (
        ("all", found),
        ("those that rub", [each for each in found if each[0]]),
        ("the others", [each for each in found if not each[0]]),
    )
    return [
        {
            "name": f"surroundings over a run of `field` without, {name} ({len(part)})",
            "value": sum(more for *_, more in part) / sum(whole for _, whole, _ in part),
            "unit": "1",
            "target": "at most 0.15",
            "note": "",
        }
        for name, part in parts
        if part
    ] + [
        {
            "name": "the same, the one run with the largest share",
            "value": max(more / whole for _, whole, more in found),
            "unit": "1",
            "target": "",
            "note": "",
        }
    ]


def measure() -> list[dict[str, object]]:
    with threadpool_limits(1):
        return measure_rows(measure_all())
