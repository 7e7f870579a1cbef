"""Simulate a few runs of a recipe to learn its classes, its time and the size of its files on this computer."""

import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from rubgen.errors import UserError
from rubgen.output import save
from rubgen.pipeline import Run, simulate
from rubgen.progress import count, step
from rubgen.scenario import Recipe


@dataclass(frozen=True, kw_only=True)
class Tried:
    """Classes, time and file sizes of some simulated runs, spread evenly over the runs of the recipe."""

    runs: int
    classes: dict[str, int]
    """Number of runs by rub and class of motion, or by status where they failed."""
    seconds_a_run: float
    """Mean CPU time of simulating and writing a run, s, without compilation."""
    megabytes_a_run: dict[str, float]
    """Mean size of the files of a good run, MB, by format; 0 where no run is good."""


def try_runs(recipe: Recipe, tries: int) -> Tried:
    """Simulate `tries` runs (1 or more) spread evenly over the recipe, or all if there are fewer, and measure them.

    Their files are written to a temporary folder, which is deleted. Failed runs count by their status, runs that are
    not possible as "refused". The time is CPU time with the writing. The first run is simulated once before, so that no
    time contains the compilation.
    """
    places = sorted({round(place) for place in np.linspace(0, recipe.runs - 1, min(tries, recipe.runs))})
    classes: Counter[str] = Counter()
    seconds, sizes = [], []
    with step("try some runs", "runs", long=True), recipe.machine_named(), TemporaryDirectory() as folder:
        _result(recipe, places[0], Path(folder))
        for number, index in enumerate(places, start=1):
            began = time.process_time()
            found, size = _result(recipe, index, Path(folder))
            seconds.append(time.process_time() - began)
            classes[found] += 1
            sizes.append(size)
            count(number, len(places))
    good = [size for size in sizes if size]
    return Tried(
        runs=len(places),
        classes=dict(classes.most_common()),
        seconds_a_run=sum(seconds) / len(seconds),
        megabytes_a_run={name: _mean([size[name] for size in good]) for name in recipe.output.formats},
    )


def _result(recipe: Recipe, index: int, folder: Path) -> tuple[str, dict[str, float]]:
    """Return the class of one run and the sizes of its files in MB."""
    try:
        run = simulate(recipe.scenario(index))
    except UserError:
        return "refused", {}
    sizes: dict[str, float] = {}
    for name in recipe.output.formats if run.labels else ():
        path = folder / f"run.{name}"
        path.unlink(missing_ok=True)
        save(run, path)
        sizes[name] = path.stat().st_size / 1e6
    return _class_of(run), sizes


def _class_of(run: Run) -> str:
    if run.labels is None:
        return run.response.status.code
    return f"{'rub' if run.labels.rub else 'no rub'}, {run.labels.motion.value}"


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values) if values else 0.0
