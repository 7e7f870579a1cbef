"""Labels of faults: which faults the machine of a run has, how severe they are, and when the rub begins."""

from rubgen.machine.faults.registry import FAULTS
from rubgen.scenario import Scenario
from rubgen.scenario.faults import kind_of
from rubgen.solver import Response, Status


def fault_labels(scenario: Scenario, response: Response) -> dict[str, object]:
    """Return the labels of faults by name: `faults`, `healthy`, `rub_onset_s`, and severities.

    There is a severity for each kind of fault that the recipe or the machine names, 0 where the run does not have the
    fault. `healthy` is True without a fault and without a rub. `rub_onset_s` is the time of the first touch in s from
    the record's start, None without a rub. `healthy` and `rub_onset_s` are None where the run failed. The result is
    empty if neither recipe nor machine have faults.
    """
    if not scenario.fault_kinds:
        return {}
    there = {kind_of(fault): fault.severity for fault in scenario.machine.faults}
    touches, good = response.events.start_step, response.status is Status.OK
    return {
        "faults": [kind for kind in FAULTS if kind in there],
        "healthy": not (touches.size or there) if good else None,
        "rub_onset_s": float(touches.min() * response.dt) if good and touches.size else None,
        **{FAULTS[kind].SEVERITY.column: float(there.get(kind, 0.0)) for kind in scenario.fault_kinds},
    }
