"""Labelled blade-rub data from a finite-element blisk in a flexible oval casing.

`make_scenario` and `simulate` make one run in memory, `generate` a whole data set, `open` reads one. Importing rubgen
imports no other module, so that a command handles Ctrl-C from its first moment: functions import what they need.
"""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from pathlib import Path

    from rubgen.dataset.making.generate import generate
    from rubgen.dataset.reading.open import DataSet
    from rubgen.errors import RubgenError, UserError
    from rubgen.pipeline import Run
    from rubgen.scenario import Scenario, load_recipe, make_scenario

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


_HOMES = {
    "RubgenError": "rubgen.errors",
    "UserError": "rubgen.errors",
    "generate": "rubgen.dataset.making.generate",
    "load_recipe": "rubgen.scenario",
    "make_scenario": "rubgen.scenario",
}
"""The modules of names that are imported on first use."""


def __getattr__(name: str) -> object:
    """The name from its module."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_HOMES[name]), name)


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
