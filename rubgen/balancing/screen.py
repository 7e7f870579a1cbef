"""Find the class of a candidate before its run: by statics where they decide, else by a short run."""

import math
from dataclasses import dataclass, replace

import numpy as np

from rubgen.errors import UserError
from rubgen.labels.label import label
from rubgen.linalg.threads import one_blas_thread
from rubgen.reduction import reduce
from rubgen.scenario import Scenario
from rubgen.solver.integrate import integrate
from rubgen.solver.linear.reach import deepest, with_clearance
from rubgen.solver.response import Status
from rubgen.solver.wants import Wants

SCREEN_TURNS = 64
"""Turns of the record of a short run. Of 23 rubbing runs 21 have the class of 500 turns (docs/balance.md)."""


@dataclass(frozen=True)
class Verdict:
    """The class of a candidate. `motion` is "" and `severity` 0 where only statics were used."""

    rub: bool
    motion: str = ""
    severity: float = 0.0


def reaches(scenario: Scenario) -> bool | None:
    """Return whether the run rubs, from its rub-free motion alone; None where this motion is not enough to know.

    A run starts in its rub-free motion, so it rubs if and only if its tips would pass through the casing. For a
    changing speed nine steady speeds are used. None is returned for supports with laws. It is also returned for a fault
    that grows, unless the tips pass through the casing from the beginning. Raises UserError for a run that is not
    possible.
    """
    with one_blas_thread():
        depth = deepest(scenario)[0]
        model = reduce(scenario.machine, scenario.reduction)
        grows = bool(model.at_speed(scenario.operation.speed_rad_per_s).ramps)
    if depth >= 0 and math.isfinite(depth):
        return True
    return None if grows or math.isinf(depth) else False


def short_run(scenario: Scenario) -> Verdict | None:
    """Return the class of the run from its first 64 turns after settling; None for a run that fails.

    The short run is the beginning of the run itself, without the companion trajectory. Its steps are the same unless
    the sensors need more: the class does not depend on the sensors, so that other sensors have the same motions. A run
    at a changing speed, or with faults that grow, is simulated to its end. Raises UserError for a run that is not
    possible.
    """
    with one_blas_thread():
        scenario = with_clearance(scenario)
        model = reduce(scenario.machine, scenario.reduction)
        operation = scenario.operation
        if operation.profile == "steady" and not model.at_speed(operation.speed_rad_per_s).ramps:
            operation = replace(operation, record_turns=min(SCREEN_TURNS, operation.record_turns))
        response = integrate(model, operation, scenario.contact, Wants(repeats_free_turn=True))
        if response.status is not Status.OK:
            return None
        labels = label(response)
    return Verdict(rub=labels.rub, motion=labels.motion.value, severity=labels.amounts.severity or 0.0)


def screen(scenario: Scenario, *, motion: bool) -> Verdict | None:
    """Return the class of a candidate; None for a candidate that is not possible or fails.

    With `motion` the class of a rubbing candidate includes its class of motion and severity, from a short run. Without
    it a short run is only made if the rub-free motion is not enough to know whether the candidate rubs.
    """
    try:
        rub = reaches(scenario)
        if rub is False or (rub and not motion):
            return Verdict(rub=rub)
        return short_run(scenario)
    except (UserError, np.linalg.LinAlgError):
        return None
