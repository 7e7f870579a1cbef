"""The runs that the three indicators are compared on, each made once and kept as its labels need it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rubgen.labels.kept import Kept, keep
from rubgen.reduction import reduce
from rubgen.scenario import Scenario, make_scenario
from rubgen.solver import Status, integrate

SERIES: dict[str, dict[str, float]] = {
    "preset": {},
    "friction 0.05": {"friction": 0.05},
    "more unbalance": {"unbalance_kg_m": 2e-2},
    "closer casing": {"clearance_m": 2.2e-4, "friction": 0.01},
}
"""Keys of `make_scenario` beside the speed."""
SPEEDS_RPM = tuple(float(speed) for speed in range(6540, 14941, 120))
"""The part of the paper's sweep in which the preset rubs."""


def scenarios() -> dict[str, Scenario]:
    """Name to scenario: every series at every speed, 500 turns each."""
    return {
        f"{name}, {speed:.0f} rev/min": make_scenario("zeng2019", speed_rpm=speed, **keys)
        for name, keys in SERIES.items()
        for speed in SPEEDS_RPM
    }


def kept_runs(folder: Path, asked: dict[str, Scenario]) -> Iterator[tuple[str, Kept]]:
    """The runs that ended well and rubbed, one after the other; what is missing in `folder` is made first."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, scenario in asked.items():
        path = folder / f"{name.replace(', ', '-').replace('/', '-').replace(' ', '-')}.npz"
        if not path.exists():
            _make(scenario, path)
        with np.load(path) as file:
            kept = dict(file)
        if kept and kept["contact_steps"].sum():
            yield name, kept


def _make(scenario: Scenario, path: Path) -> None:
    operation = scenario.operation
    model = reduce(scenario.machine, scenario.reduction)
    response = integrate(model.at_speed(operation.speed_rad_per_s), operation, scenario.contact, twin=True)
    part = path.with_suffix(".part")
    with part.open("wb") as stream:
        np.savez_compressed(stream, **(keep(response) if response.status is Status.OK else {}))  # type: ignore[arg-type]
    part.replace(path)
