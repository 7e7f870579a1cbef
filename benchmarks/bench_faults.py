"""What a fault costs in a step: turns of the preset with it and without it, in turn, with a light rub.

A ratio of CPU times is little changed by other work on the machine. Each fault is small, so that the rub stays alike.
"""

from __future__ import annotations

import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks.cpu_time import cpu_time
from rubgen import make_scenario
from rubgen.reduction import reduce
from rubgen.solver.scheme.stepper import Stepper
from rubgen.solver.speed.start import closing_ramp, rub_free_stepper, start_opening

STEPS, SETTLE_TURNS, CLOSING_TURNS, TURNS, ROUNDS = 1024, 120, 40, 6, 41
RUB = {"speed_rpm": 10_000.0, "disk_support_stiffness_n_per_m": 2e8}
FAULTS: dict[str, dict[str, object]] = {
    "none": {},
    "misalignment": {"fault": "misalignment", "parallel_m": 2e-5},
    "bow": {"fault": "bow", "bow_m": 2e-6},
    "casing-off-centre": {"fault": "casing-off-centre", "offset_m": 2e-6},
    "cracked-blade": {"fault": "cracked-blade", "stiffness_loss": 0.01},
}


def settled(keys: dict[str, object]) -> Stepper:
    """A stepper in its rub."""
    scenario = make_scenario("zeng2019", **RUB, **keys)  # type: ignore[arg-type]
    system = reduce(scenario.machine, scenario.reduction).at_speed(scenario.operation.speed_rad_per_s)
    stepper, opening = rub_free_stepper(system, scenario.contact, STEPS), start_opening(system)
    for turn in range(SETTLE_TURNS):
        stepper.run_turn(opening * closing_ramp((turn + np.arange(-1, STEPS + 1) / STEPS) / CLOSING_TURNS))
    return stepper


def measure() -> list[dict[str, object]]:
    with threadpool_limits(1):
        steppers = {name: settled(keys) for name, keys in FAULTS.items()}
        times: dict[str, list[float]] = {name: [] for name in steppers}
        for number in range(ROUNDS):
            for name in list(steppers)[:: 1 if number % 2 else -1]:
                times[name].append(cpu_time(lambda name=name: [steppers[name].run_turn() for _ in range(TURNS)]))  # type: ignore[misc]
    healthy = np.array(times.pop("none"))
    return [
        {
            "name": f"step of a light rub with {name}, over one without",
            "value": float(np.median(np.array(found) / healthy)),
            "unit": "1",
            "target": "at most 1.15",
            "note": "",
        }
        for name, found in times.items()
    ]
