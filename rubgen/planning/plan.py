"""Plan a data set: what its recipe draws, which runs can rub, what is refused, what it costs."""

import math
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from rubgen.errors import UserError
from rubgen.planning.drawn import Drawn, drawn_keys
from rubgen.planning.tried import Tried, try_runs
from rubgen.progress import count, step
from rubgen.scenario import Recipe, Scenario
from rubgen.scenario.costs import SECONDS_A_CANDIDATE, file_bytes, run_seconds
from rubgen.solver.linear.reach import deepest

LOOKED_AT, WITH_MACHINES = 64, 16
"""Runs whose free penetration is computed; fewer where most of them have a machine of their own to reduce."""
COUNTED = 10_000
"""Runs whose splits are counted one by one."""


@dataclass(frozen=True, kw_only=True)
class Reach:
    """How deep the tips of one run would enter the casing without contact, or why the run is refused."""

    depth_m: float
    """Largest free penetration; a gap is negative, NaN in a refused run, infinite where only the run shows it."""
    refused: str = ""

    @property
    def can_rub(self) -> bool:
        """Whether a blade reaches the casing in the motion without contact. True where this motion is not known."""
        return not self.refused and self.depth_m >= 0


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What a recipe draws and what its data set costs. Shares refer to some runs, spread evenly over all runs."""

    name: str
    runs: int
    machine: str
    machines: int
    balanced: bool
    """Whether candidates are looked at of which `[balance]` will choose."""
    splits: dict[str, int]
    """Number of runs of each split."""
    drawn: tuple[Drawn, ...]
    reach: tuple[Reach, ...]
    """One for each examined run."""
    corners: int
    """Number of scenarios at the extremes of what is drawn."""
    refused_corners: tuple[str, ...]
    """The reason of each of these scenarios that is refused."""
    cpu_seconds: float
    megabytes: dict[str, float]
    """Size of the files by format."""
    tried: Tried | None
    """Results of a few simulated runs, or None. If there are any, time and sizes follow from them."""

    @property
    def share_that_can_rub(self) -> float:
        """Share of the examined runs in which a blade can reach the casing. Refused runs are left out.

        It is 0 if all are refused.
        """
        possible = [each for each in self.reach if not each.refused]
        return sum(each.can_rub for each in possible) / len(possible) if possible else 0.0


def plan(recipe: Recipe, *, tries: int = 0) -> Plan:
    """Examine a recipe before its data set is made. Nothing is integrated in time unless `tries` is above 0.

    The recipe must be checked already (`load_recipe`). Up to 64 runs are examined, 16 where virtual machines are drawn.
    The extremes of `[vary]` are examined too, except where virtual machines are drawn. With `[balance]` the first
    candidate of each run is examined, which may not be chosen later. A run that is not possible is in the result with
    its reason. `tries` is the number of runs to simulate.
    """
    scenarios = list(_looked_at(recipe))
    with recipe.machine_named(), step("look at the runs", "runs", long=True):
        reach = tuple(_reaches(scenarios))
    with step("look at the extremes", long=True):
        corners = [] if recipe.machines else list(recipe.corners())
        refused = dict.fromkeys(each.refused for each in _reaches(corners) if each.refused)
    tried = try_runs(recipe, tries) if tries else None
    costs = [(each, run) for each, run in zip(scenarios, reach, strict=True) if not run.refused]
    return Plan(
        name=recipe.name,
        runs=recipe.runs,
        machine=", ".join(recipe.files),
        machines=recipe.machine_count,
        balanced=recipe.balance is not None,
        splits=_splits(recipe),
        drawn=tuple(drawn_keys(recipe, scenarios)),
        reach=reach,
        corners=len(corners),
        refused_corners=tuple(refused),
        cpu_seconds=recipe.runs * (tried.seconds_a_run if tried else _mean_seconds(recipe, costs))
        + _machine_seconds(recipe, scenarios),
        megabytes=_megabytes(recipe, costs, tried),
        tried=tried,
    )


def _looked_at(recipe: Recipe) -> Iterator[Scenario]:
    most = WITH_MACHINES if recipe.machines else LOOKED_AT
    places = sorted({round(place) for place in np.linspace(0, recipe.runs - 1, min(most, recipe.runs))})
    return (recipe.scenario(index, screened=False) for index in places)


def _reaches(scenarios: Iterable[Scenario]) -> Iterator[Reach]:
    every = list(scenarios)
    for number, scenario in enumerate(every, start=1):
        yield _reach(scenario)
        count(number, len(every))


def _reach(scenario: Scenario) -> Reach:
    if scenario.virtual and scenario.virtual.problem:
        return Reach(depth_m=math.nan, refused=scenario.virtual.problem)
    try:
        return Reach(depth_m=deepest(scenario)[0])
    except UserError as error:
        return Reach(depth_m=math.nan, refused=str(error))
    except np.linalg.LinAlgError as error:
        return Reach(depth_m=math.nan, refused=f"the machine has no rub-free motion ({error})")


def _mean_seconds(recipe: Recipe, costs: list[tuple[Scenario, Reach]]) -> float:
    formats = recipe.output.formats
    seconds = [run_seconds(each, rubs=run.can_rub, formats=formats) for each, run in costs]
    return sum(seconds) / len(seconds) if seconds else 0.0


def _machine_seconds(recipe: Recipe, scenarios: list[Scenario]) -> float:
    """Estimate the CPU time to draw all virtual machines: each candidate is reduced and checked once."""
    candidates = [each.virtual.candidate + 1 for each in scenarios if each.virtual]
    return recipe.machine_count * SECONDS_A_CANDIDATE * sum(candidates) / len(candidates) if candidates else 0.0


def _megabytes(recipe: Recipe, costs: list[tuple[Scenario, Reach]], tried: Tried | None) -> dict[str, float]:
    if tried:
        return {name: recipe.runs * size for name, size in tried.megabytes_a_run.items()}
    each = max(len(costs), 1)
    return {
        name: recipe.runs * sum(file_bytes(scenario, name) for scenario, _ in costs) / each / 1e6
        for name in recipe.output.formats
    }


def _splits(recipe: Recipe) -> dict[str, int]:
    """Count the runs of each split; of a large set by proportion of its first runs."""
    counted = min(recipe.runs, COUNTED)
    found = Counter(recipe.split_of(index) for index in range(counted))
    return {name: round(found[name] * recipe.runs / counted) for name in recipe.split_names}
