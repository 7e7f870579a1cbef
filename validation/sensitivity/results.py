"""The results of the studies, from the runs that are finished."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from rubgen.scenario import Scenario
from validation.sensitivity.cases import CASES, Study, case
from validation.sensitivity.outcome import Outcome

Shorten = Callable[[Scenario], Scenario]
"""Cuts the turns of a scenario, or leaves it as it is."""


@dataclass(frozen=True, kw_only=True)
class Result:
    """The outcome of one case with one value of the number that a study varies."""

    case: str
    value: int
    outcome: Outcome

    def as_dict(self) -> dict[str, object]:
        """`case`, `value` and the fields of `Outcome`."""
        return {"case": self.case, "value": self.value} | self.outcome.as_dict()


Results = list[Result]


def varied(study: Study, values: Sequence[int], shorten: Shorten) -> dict[tuple[str, int], Scenario]:
    """The scenarios of a study by case and value; turns are cut before the value is set."""
    return {(name, value): study.apply(shorten(case(name)), value) for value in values for name in CASES}


def of_case(results: Results, name: str) -> dict[int, Outcome]:
    """The outcomes of one case by value."""
    return {result.value: result.outcome for result in results if result.case == name}


def change(outcome: Outcome, yardstick: Outcome, read: Callable[[Outcome], float]) -> float:
    """Relative change of what `read` returns against the yardstick; NaN where a run failed or the yardstick is 0."""
    try:
        reference = read(yardstick)
        return read(outcome) / reference - 1 if reference else math.nan
    except IndexError:  # a failed run has no orders
        return math.nan
