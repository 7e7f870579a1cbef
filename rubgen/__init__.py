"""Labelled blade-rub data from a finite-element blisk in a flexible oval casing.

`make_scenario` and `simulate` make one run in memory, `stream` the runs of a recipe, `generate` a whole data set,
`merge` one set of several. `open` reads a set. Importing rubgen imports no other module, so that a command handles
Ctrl-C from its first moment. Functions import what they need.
"""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from pathlib import Path

    from rubgen.dataset.making.generate import generate
    from rubgen.dataset.making.resense import resense
    from rubgen.dataset.merging.merge import merge
    from rubgen.dataset.reading.open import DataSet
    from rubgen.dataset.remote.push import push
    from rubgen.errors import RubgenError, UserError
    from rubgen.pipeline import Run
    from rubgen.scenario import Scenario, load_recipe, make_scenario
    from rubgen.streaming import stream

__all__ = [
    "RubgenError",
    "UserError",
    "__version__",
    "generate",
    "load_recipe",
    "make_scenario",
    "merge",
    "open",
    "push",
    "resense",
    "simulate",
    "stream",
    "verify",
]
__version__ = "0.1.0"


_HOMES = {
    "RubgenError": "rubgen.errors",
    "UserError": "rubgen.errors",
    "generate": "rubgen.dataset.making.generate",
    "load_recipe": "rubgen.scenario",
    "make_scenario": "rubgen.scenario",
    "merge": "rubgen.dataset.merging.merge",
    "push": "rubgen.dataset.remote.push",
    "resense": "rubgen.dataset.making.resense",
    "stream": "rubgen.streaming",
}
"""The modules of names that are imported on first use."""


def __getattr__(name: str) -> object:
    """Import the public name `name` from its module on first use. Raise AttributeError for any other name."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return __all__


def simulate(scenario: Scenario) -> Run:
    """Simulate the run that `scenario` describes and return its true response, recorded channels and labels.

    Progress is shown on a terminal and in a notebook. A run that fails has `response.status` and `response.reason`, but
    its recording and labels are None. Raises UserError for what is no Scenario, and for a scenario that is not
    possible, such as a machine that cannot be modelled or reduced, or a record too short for its signals. See
    `rubgen.pipeline.simulate`.
    """
    from rubgen.pipeline import simulate
    from rubgen.progress import shown

    with shown():
        return simulate(scenario)


def open(directory: Path | str) -> DataSet:  # noqa: A001
    """Open the data set in `directory`: `.runs` is a DataFrame, `.signals(run_id)` are arrays, read on demand.

    `directory` may be a URL such as s3://bucket/set. Raises UserError where it holds no finished data set.
    """
    from rubgen.dataset.reading.open import DataSet

    return DataSet(directory)


def verify(directory: Path | str) -> list[str]:
    """Check the data set in `directory` and return its problems, one sentence each. The list is empty for a good set.

    Raises UserError where the directory holds no finished data set, where its manifest is damaged, and for a URL.
    """
    from rubgen.dataset.checking.verify import verify

    return verify(directory)
