"""Time of one step of the solver, with everything it books, against the same step in plain numpy."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from threadpoolctl import threadpool_limits

from rubgen.machine import load_machine
from rubgen.reduction import reduce
from rubgen.scenario import ContactLaw, Reduction
from rubgen.solver import Stepper
from rubgen.solver.reference import ReferenceStepper
from rubgen.solver.stepper import closing_ramp

SPEED_RPM = 6900.0
STEPS = 1024
CLOSING_TURNS = 40
TURNS = 4
NUMPY_STEPS = 128
REPEATS = 20


def fastest(job: Callable[[], float]) -> float:
    """The least time per step in us of a few repeats: the one that neighbours disturbed least."""
    return min(job() for _ in range(REPEATS))


def measure() -> list[dict[str, object]]:
    """Step times of the preset in light contact, on one thread, and their ratio."""
    system = reduce(load_machine("zeng2019"), Reduction()).at_speed(SPEED_RPM * np.pi / 30)
    with threadpool_limits(1):
        stepper = Stepper(system, ContactLaw(friction=0.1), STEPS)
        for turn in range(CLOSING_TURNS + 1):
            ramp = closing_ramp((turn + np.arange(-1, STEPS + 1) / STEPS) / CLOSING_TURNS)
            stepper.run_turn(2e-4 * ramp)
        reference = ReferenceStepper(system, 0.1, STEPS)
        reference.before, reference.now = stepper.state.before.copy(), stepper.state.now.copy()
        touched = 0.0

        def kernel_turns() -> float:
            nonlocal touched
            start = time.perf_counter()
            for _ in range(TURNS):
                stepper.run_turn()
                touched += stepper.result.summary[1]
            return 1e6 * (time.perf_counter() - start) / TURNS / STEPS

        def numpy_steps() -> float:
            start = time.perf_counter()
            for s in range(NUMPY_STEPS):
                reference.step(s)
            return 1e6 * (time.perf_counter() - start) / NUMPY_STEPS

        # Taken in turns, so that both meet the same neighbours on the machine.
        pairs = [(fastest(kernel_turns), fastest(numpy_steps)) for _ in range(2)]
    ours, plain = min(pair[0] for pair in pairs), min(pair[1] for pair in pairs)
    if not touched:
        raise RuntimeError("the benchmark's run had no contact")
    share = float(touched / (2 * REPEATS * TURNS * STEPS))
    return [
        {"name": "solver step, preset in light contact", "value": ours, "unit": "us", "target": "about 5"},
        {"name": "the same step in plain numpy", "value": plain, "unit": "us", "target": "recorded"},
        {"name": "plain numpy step over solver step", "value": plain / ours, "unit": "ratio", "target": ">= 15"},
        {"name": "share of those steps with contact", "value": share, "unit": "1", "target": "recorded"},
    ]


if __name__ == "__main__":
    for line in measure():
        print(line)
