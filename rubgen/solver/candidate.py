"""Check a candidate of a virtual machine before it is used: it can be reduced, is stable, and is inside its bounds."""

import math

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.errors import UserError
from rubgen.linalg.threads import one_blas_thread
from rubgen.reduction import ReducedModel, reduce
from rubgen.scenario import Scenario
from rubgen.scenario.tables.machines import MachineTable
from rubgen.solver.linear.admissible import check_system
from rubgen.solver.linear.reach import onset_clearance
from rubgen.solver.refusal import stability

STABILITY_SPEEDS, ONSET_SPEEDS = 3, 9
"""Numbers of speeds from the slowest to the fastest of the recipe, ends included."""


def candidate_problem(scenario: Scenario, bounds: MachineTable, slowest: float, fastest: float) -> str | None:
    """Return why the machine of a scenario cannot be used, key and value first; None where it can be used.

    - scenario: a run of the machine.
    - bounds: the table `[machines]` of the recipe, with the bounds of critical speed and onset clearance.
    - slowest, fastest: the speeds of the recipe, rad/s.

    Checked in this order: reduction, critical speed, stability at three speeds, and at nine speeds the clearance at
    which the blades just reach the casing (`onset_clearance`). The speeds go in equal steps from the slowest to the
    fastest. A critical speed or onset clearance without bounds is not checked. With bounds, an onset clearance that is
    not known is a reason. An error of a check is returned as the reason, not raised.
    """
    try:
        with one_blas_thread():
            model = reduce(scenario.machine, scenario.reduction)
            return (
                _outside("critical_speed_rpm", model.critical_speed_rpm, bounds.critical_speed_rpm)
                or _unstable(model, np.linspace(slowest, fastest, STABILITY_SPEEDS))
                or _onset(model, scenario, bounds, np.linspace(slowest, fastest, ONSET_SPEEDS))
            )
    except (UserError, np.linalg.LinAlgError) as error:
        return str(error)


def _outside(key: str, value: float, bounds: tuple[float, float] | None) -> str | None:
    if bounds is None or bounds[0] <= value <= bounds[1]:
        return None
    return f"{key} = {value:.6g}: outside of [{bounds[0]:g}, {bounds[1]:g}]"


def _unstable(model: ReducedModel, speeds: FloatArray) -> str | None:
    for speed in dict.fromkeys(speeds.tolist()):
        system = model.at_speed(speed)
        check_system(system)
        refusal = stability(system)[0]
        if refusal:
            return f"{refusal[0].code} = true: {refusal[1]}"
    return None


def _onset(
    model: ReducedModel,
    scenario: Scenario,
    bounds: MachineTable,
    speeds: FloatArray,
) -> str | None:
    if bounds.onset_clearance_m is None:
        return None
    onset = onset_clearance(model, scenario, list(dict.fromkeys(speeds.tolist())))
    if not math.isfinite(onset):
        return "onset_clearance_m = unknown: laws of the support leave the motion without rub unknown; remove it"
    return _outside("onset_clearance_m", onset, bounds.onset_clearance_m)
