"""What a recipe draws: each key with its distribution and the values of the runs that are looked at."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from pydantic import BaseModel

from rubgen.machine.faults.fault import Fault
from rubgen.machine.sentences import toml_text
from rubgen.scenario import Recipe, Scenario
from rubgen.scenario.faults import kind_of
from rubgen.scenario.vary import FREE_PENETRATION


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """One key that a recipe draws or fixes."""

    key: str
    """With its table: vary.speed_rpm."""
    how: str
    """As in the recipe: a number, or a distribution."""
    values: tuple[float, ...] = field(repr=False)
    """Of the runs looked at that have the key, in their order."""
    runs: tuple[int, ...] = field(repr=False)
    """The indices of these runs among the examined runs."""


def drawn_keys(recipe: Recipe, scenarios: Sequence[Scenario]) -> list[Drawn]:
    """Return every key of the recipe that draws or fixes a value, with its values in the runs `scenarios`.

    Tones of the surroundings, words that are not drawn, and the keys of splits and twins are left out.
    """
    parts = (_machines, _varied, _around, _faults)
    return [each for part in parts for each in part(recipe, scenarios)]


def _machines(recipe: Recipe, scenarios: Sequence[Scenario]) -> Iterator[Drawn]:
    for entry, distribution in recipe.machines.distributions() if recipe.machines else ():
        values = [float(entry.read(each.machine)) for each in scenarios]
        yield _drawn(f"machines.{entry.key}", distribution, dict(enumerate(values)))


def _varied(recipe: Recipe, scenarios: Sequence[Scenario]) -> Iterator[Drawn]:
    for entry, distribution in recipe.distributions():
        if entry is FREE_PENETRATION:
            values = [each.free_penetration_m or 0.0 for each in scenarios]
        else:
            values = [entry.read(each) for each in scenarios]
        yield _drawn(f"vary.{entry.key}", distribution, dict(enumerate(values)))


def _around(recipe: Recipe, scenarios: Sequence[Scenario]) -> Iterator[Drawn]:
    for key, distribution in _given(recipe.surroundings):
        found = {place: getattr(each.surroundings, key) for place, each in enumerate(scenarios) if each.surroundings}
        yield _drawn(f"surroundings.{key}", distribution, found)


def _faults(recipe: Recipe, scenarios: Sequence[Scenario]) -> Iterator[Drawn]:
    """Yield the keys of each kind of fault; the share says how many of the runs have it."""
    for table in recipe.faults or ():
        kind = kind_of(table)
        found = {place: _fault(scenario, kind) for place, scenario in enumerate(scenarios)}
        having = {place: fault for place, fault in found.items() if fault}
        for key, distribution in _given(table):
            if key == "share":
                yield _drawn(f"faults.{kind}", distribution, {}, f" of the runs, {len(having)} of {len(found)} here")
            else:
                values = {place: getattr(fault, key) for place, fault in having.items()}
                numbers = {place: value for place, value in values.items() if isinstance(value, int | float)}
                yield _drawn(f"faults.{kind}.{key}", distribution, numbers)


def _fault(scenario: Scenario, kind: str) -> Fault | None:
    return next((fault for fault in scenario.machine.faults if kind_of(fault) == kind), None)


def _given(table: Any) -> Iterator[tuple[str, Any]]:
    """Yield the keys of a table that draw: all that are given, except for lists and names."""
    for key in type(table).model_fields if table is not None else ():
        value = getattr(table, key)
        if isinstance(value, BaseModel):
            yield key, value


def _drawn(key: str, distribution: BaseModel, values: dict[int, float], more: str = "") -> Drawn:
    how = toml_text(distribution.model_dump(mode="json")) + more
    return Drawn(key=key, how=how, values=tuple(map(float, values.values())), runs=tuple(values))
