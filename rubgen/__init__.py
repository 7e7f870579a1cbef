"""Labelled blade-rub data from a finite-element blisk in a flexible oval casing.

`make_scenario` and `simulate` make one run in memory, `generate` a whole data set, `open` reads one. Importing rubgen
imports no other module, so that a command handles Ctrl-C from its first moment: functions import what they need.
"""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from rubgen.dataset.making.generate import Generated
    from rubgen.dataset.reading.open import DataSet
    from rubgen.errors import RubgenError, UserError
    from rubgen.pipeline import Run
    from rubgen.scenario import Recipe, Scenario, make_scenario

__all__ = [
    "RubgenError",
    "UserError",
    "__version__",
    "generate",
    "load_recipe",
    "make_scenario",
    "open",
    "simulate",
    "verify",
]
__version__ = "0.1.0"


def __getattr__(name: str) -> object:
    """`make_scenario` and the errors, imported on first use."""
    if name == "make_scenario":
        from rubgen.scenario import make_scenario

        return make_scenario
    if name in ("RubgenError", "UserError"):
        from rubgen import errors

        return getattr(errors, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__


def simulate(scenario: Scenario) -> Run:
    """The run of `scenario` in memory: true response, recorded channels and labels. See `rubgen.pipeline.simulate`.

    A run that fails has `response.status` and `response.reason`, but no recording and no labels. Raises UserError for a
    machine that cannot be modelled or reduced as asked, or a record too short for its signals.
    """
    from rubgen.pipeline import simulate
    from rubgen.progress import shown

    with shown():
        return simulate(scenario)


def load_recipe(path: Path | str | None = None, *, runs: int | None = None) -> Recipe:
    """The recipe in that TOML file, or the default recipe of rubgen; `runs` overrides its number of runs.

    Raises UserError with file, key, value and what is allowed.
    """
    from rubgen.scenario import load_recipe

    return load_recipe(path, runs=runs)


def generate(
    recipe: Recipe | Mapping[str, object] | Path | str | None,
    out: Path | str,
    *,
    runs: int | None = None,
    workers: int | None = None,
    progress: Callable[[int, int], None] | bool | None = None,
) -> Generated:
    """The data set of a recipe in the directory `out`. A set that was begun there is completed.

    - recipe: a Recipe, its TOML values, the path of its file, or None for the default recipe.
    - out: directory of the data set; made where it is missing.
    - runs: overrides the recipe's number of runs.
    - workers: number of processes; one for each usable core with None.
    - progress: None shows it on a terminal and in a notebook, True everywhere, False nowhere. A function is called with
      the numbers of finished and of all runs.

    See `rubgen.dataset.making.generate`. Raises UserError for bad input, a directory that has other content or cannot
    be written, and a full disk; RubgenError where a worker process dies.
    """
    from rubgen.dataset.making.generate import generate

    return generate(recipe, out, runs=runs, workers=workers, progress=progress)


def open(directory: Path | str) -> DataSet:  # noqa: A001
    """The data set in that directory: `.runs` as a DataFrame, `.signals(run_id)` as arrays, read on demand.

    Raises UserError where the directory holds no finished data set.
    """
    from rubgen.dataset.reading.open import DataSet

    return DataSet(directory)


def verify(directory: Path | str) -> list[str]:
    """Problems of the data set in that directory, one sentence each; empty without problems.

    Raises UserError where the directory holds no finished data set.
    """
    from rubgen.dataset.checking.verify import verify

    return verify(directory)
