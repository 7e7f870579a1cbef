"""Labels of faults: what is wrong with the machine of a run, beside what the run shows."""

from rubgen.machine.faults.registry import FAULTS
from rubgen.scenario import Scenario
from rubgen.scenario.faults import kind_of


def fault_labels(scenario: Scenario, *, rub: bool | None) -> dict[str, object]:
    """The labels of faults by name: `faults`, `healthy`, and the severity of each kind that the recipe names.

    A severity is 0 where the run does not have that fault. `healthy` is true without a fault and without a rub; `rub`
    is None for a run that failed, and so is `healthy`. A recipe and a machine without faults have no such label.
    """
    if not scenario.fault_kinds:
        return {}
    there = {kind_of(fault): fault.severity for fault in scenario.machine.faults}
    return {
        "faults": [kind for kind in FAULTS if kind in there],
        "healthy": None if rub is None else not (rub or there),
        **{FAULTS[kind].SEVERITY.column: float(there.get(kind, 0.0)) for kind in scenario.fault_kinds},
    }
