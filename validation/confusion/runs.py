"""The runs that the three indicators are compared on, each made once and kept as its labels need it."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from rubgen.dataset.making.workers import unordered, worker_pool
from rubgen.labels.compact_record import Kept, keep
from rubgen.reduction import reduce
from rubgen.scenario import Scenario, make_scenario
from rubgen.scenario.vary import vary
from rubgen.solver import Status
from rubgen.solver.integrate import integrate

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


def make_missing(folder: Path, asked: dict[str, Scenario], workers: int) -> Iterator[int]:
    """Make the runs that `folder` lacks, in `workers` processes; gives how many are there after each."""
    folder.mkdir(parents=True, exist_ok=True)
    missing = [(name, scenario) for name, scenario in asked.items() if not _path(folder, name).exists()]
    done = len(asked) - len(missing)
    yield done
    jobs = ((scenario, _path(folder, name)) for name, scenario in missing)
    if workers == 1 or len(missing) < 2:
        for job in jobs:
            _make(*job)
            yield (done := done + 1)
        return
    with worker_pool(workers) as pool:
        for _ in unordered(pool, workers, _make, jobs):
            yield (done := done + 1)


def kept_runs(folder: Path, asked: dict[str, Scenario]) -> Iterator[tuple[str, Kept]]:
    """The runs in `folder` that ended well and rubbed, one after the other."""
    for name in asked:
        with np.load(_path(folder, name)) as file:
            kept = dict(file)
        if kept and kept["contact_steps"].sum():
            yield name, kept


def _path(folder: Path, name: str) -> Path:
    return folder / f"{name.replace(', ', '-').replace('/', '-').replace(' ', '-')}.npz"


def _make(scenario: Scenario, path: Path) -> None:
    operation = scenario.operation
    with threadpool_limits(1, user_api="blas"):
        model = reduce(scenario.machine, scenario.reduction)
        response = integrate(model.at_speed(operation.speed_rad_per_s), operation, scenario.contact, twin=True)
    part = path.with_suffix(f".{os.getpid()}.part")
    with part.open("wb") as stream:
        np.savez_compressed(stream, **(keep(response) if response.status is Status.OK else {}))  # type: ignore[arg-type]
    part.replace(path)
