"""Time of one step of the solver, with everything it books, against the same step in plain numpy.

Four runs of the preset, settled first: regular light rub, irregular rub, heavy rub, and the first with mistuned blades.
Each is then held to the numpy reference: states over one turn restarted from the reference at each of 50 turns, and the
number of steps in contact.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks.cpu_time import cpu_time
from benchmarks.rows import rows_of
from rubgen import make_scenario
from rubgen.reduction import reduce
from rubgen.scenario import ContactLaw, Reduction
from rubgen.solver.scheme.stepper import Stepper
from rubgen.solver.speed.start import closing_ramp, rub_free_stepper, start_opening
from validation.reference_step import ReferenceStepper

STEPS = 1024
CLOSING_TURNS, SETTLE_TURNS = 40, 120
RESTARTS = 50
ROUNDS, TURNS = 9, 10
"""Turns of the reference that are timed, and turns of ours beside each."""


@dataclass(frozen=True)
class Case:
    """A run of the preset, by the keys of `make_scenario`."""

    name: str
    keys: dict[str, float]
    friction: float
    target: str
    mistuning: float = 0.0
    """Relative standard deviation of the tips' tangential stiffness: no nodal diameters, one block of 114."""


CASES = (
    Case("period-1", {"speed_rpm": 10000.0, "disk_support_stiffness_n_per_m": 2e8}, 0.1, ">= 75, goal 120"),
    Case("chaotic", {"speed_rpm": 6900.0}, 0.1, ">= 75, goal 120"),
    Case(
        "heavy rub",
        {
            "speed_rpm": 12000.0,
            "disk_support_stiffness_n_per_m": 8.6e7,
            "casing_support_stiffness_n_per_m": 4e5,
        },
        0.0,
        ">= 75",
    ),
    Case("mistuned", {"speed_rpm": 10000.0, "disk_support_stiffness_n_per_m": 2e8}, 0.1, ">= 30", mistuning=1e-3),
)


def settled(case: Case) -> tuple[Stepper, ReferenceStepper]:
    """The solver and the reference in the same state of the settled run."""
    scenario = make_scenario("zeng2019", **case.keys)
    system = reduce(scenario.machine, Reduction()).at_speed(scenario.operation.speed_rad_per_s)
    if case.mistuning:
        tangential, K = np.arange(1, 3 * system.n_blades, 3), system.K.copy()
        K[tangential, tangential] *= 1 + case.mistuning * np.random.default_rng(0).normal(size=system.n_blades)
        system = replace(system, K=K)
    stepper, opening = rub_free_stepper(system, ContactLaw(friction=case.friction), STEPS), start_opening(system)
    for turn in range(CLOSING_TURNS + SETTLE_TURNS):
        ramp = closing_ramp((turn + np.arange(-1, STEPS + 1) / STEPS) / CLOSING_TURNS)
        code, step, _ = stepper.run_turn(opening * ramp)
        if code != 0:
            raise RuntimeError(f"the {case.name} run ended in turn {turn}, step {step}")
    reference = ReferenceStepper(system, case.friction, STEPS)
    reference.before, reference.now = stepper.coordinates.before, stepper.coordinates.now
    return stepper, reference


def turn_time(reference: ReferenceStepper) -> float:
    """CPU time in us of a step of the reference over one turn; its state is the same afterwards."""
    before, now = reference.before, reference.now

    def turn() -> None:
        for index in range(reference.steps):
            reference.step(index)

    spent = cpu_time(turn)
    reference.set_state(before, now)
    return 1e6 * spent / reference.steps


def step_times(stepper: Stepper, reference: ReferenceStepper) -> tuple[float, float, float]:
    """Median CPU times of our step and of the reference's in us, over whole turns; the share of our steps in contact.

    Both take turns, so that they meet the same neighbours on the machine.
    """
    ours, plain, touched = list[float](), list[float](), 0.0
    for _ in range(ROUNDS):
        for _ in range(TURNS):
            ours.append(cpu_time(stepper.run_turn) / STEPS)
            touched += stepper.result.summary[1]
        plain.append(turn_time(reference))
    return 1e6 * float(np.median(ours)), float(np.median(plain)), touched / len(ours) / STEPS


def deviation(stepper: Stepper, reference: ReferenceStepper) -> tuple[float, int]:
    """Largest relative difference of states after one turn, and in how many of 50 turns contact counts differ."""
    start, worst, unequal = stepper.system.casing_start, 0.0, 0
    for _ in range(RESTARTS):
        stepper.set_coordinates(reference.before, reference.now)
        stepper.run_turn()
        touching = sum(reference.step(s) > 0 for s in range(STEPS))
        unequal += int(touching != stepper.result.summary[1])
        for part in (slice(0, start), slice(start, None)):
            difference = np.abs(stepper.coordinates.now[part] - reference.now[part]).max()
            worst = max(worst, float(difference / np.abs(reference.now[part]).max()))
    return worst, unequal


def measure_case(case: Case) -> list[dict[str, object]]:
    """Rows of one run."""
    stepper, reference = settled(case)
    worst, unequal = deviation(stepper, reference)
    ours, plain, share = step_times(stepper, reference)
    if not share:
        raise RuntimeError(f"the {case.name} run had no contact")
    rows = (
        ("solver step", ours, "us", "recorded"),
        ("plain numpy step", plain, "us", "recorded"),
        ("numpy over solver", plain / ours, "ratio", case.target),
        ("steps with contact", share, "1", "recorded"),
        ("largest deviation over a turn", worst, "1", "<= 1e-6"),
        ("turns of 50 with other contacts", unequal, "turns", "0"),
    )
    return rows_of(rows, f"{case.name}: ")


def measure() -> list[dict[str, object]]:
    """All rows, on one thread."""
    with threadpool_limits(1):
        return [row for case in CASES for row in measure_case(case)]


if __name__ == "__main__":
    for line in measure():
        print(line)
