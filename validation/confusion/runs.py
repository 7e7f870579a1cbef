"""The runs that the three indicators are compared on, each kept as its labels need it."""

from __future__ import annotations

from rubgen.labels.compact_record import compact_record
from rubgen.reduction import reduce
from rubgen.scenario import Scenario, make_scenario
from rubgen.scenario.vary import vary
from rubgen.solver import Status
from rubgen.solver.integrate import integrate
from rubgen.solver.wants import Wants
from validation.piece import MOTION_LABELS, Arrays, Piece

SERIES: dict[str, dict[str, float]] = {
    "preset": {},
    "friction 0.05": {"friction": 0.05},
    "more unbalance": {"unbalance_kg_m": 2e-2},
    "closer casing": {"clearance_m": 2.2e-4, "friction": 0.01},
}
"""Keys of `[vary]` beside the speed."""
SPEEDS_RPM = tuple(float(speed) for speed in range(6540, 14941, 120))
"""The part of the paper's sweep in which the preset rubs."""


def run_name(series: str, speed_rpm: float) -> str:
    """Name of a run."""
    return f"{series}, {speed_rpm:.0f} rev/min"


def scenarios(*, every: int = 1) -> dict[str, Scenario]:
    """Name to scenario: every series at every so many-th speed, 500 turns each."""
    return {
        run_name(name, speed): vary(make_scenario("zeng2019"), {"speed_rpm": speed, **keys})
        for name, keys in SERIES.items()
        for speed in SPEEDS_RPM[::every]
    }


def run_piece(scenario: Scenario) -> Piece:
    """The piece that runs the scenario; labels are made when it is read."""
    return Piece(run, (scenario,), apart=MOTION_LABELS)


def run(scenario: Scenario) -> Arrays:
    """What is kept of the response, with its companion; nothing of a run that failed."""
    operation = scenario.operation
    model = reduce(scenario.machine, scenario.reduction)
    response = integrate(model, operation, scenario.contact, Wants(companion=True))
    return compact_record(response) if response.status is Status.OK else {}


def rubs(kept: Arrays) -> bool:
    """Whether the run ended well and rubbed."""
    return bool(kept) and bool(kept["contact_steps"].sum())
