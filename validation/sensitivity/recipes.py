"""How often half the step moves the class of motion in the recipes, and whether the confidence says so."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache

from benchmarks.bench_recipe import RECIPE
from rubgen.labels.compact_record import CompactRecord, response_of
from rubgen.labels.motion.classify import Motions, motion
from rubgen.machine.toml_file import read_toml
from rubgen.scenario import Recipe, Scenario
from rubgen.scenario.load import RECIPES as FOLDER
from rubgen.scenario.load import parse_recipe
from rubgen.solver.exponent import lyapunov
from validation.confusion.runs import rubs, run_piece
from validation.piece import Arrays, Piece
from validation.sensitivity.cases import with_operation
from validation.sensitivity.halving import STEPS
from validation.sensitivity.results import Shorten

RECIPES = ("laboratory", "thousand", "rig", "speed-sweep", "three-lobes")
"""Those with a steady speed. At a changing speed the motion of a run with contact is always undecided."""
SEEDS = {"fit": 101, "check": 202}
"""Constants of the confidence may be fitted to the first only; the second shows what the confidence is worth."""
RUNS = 32
"""Runs of each recipe and seed: 320, some ten minutes of CPU time."""
SEEN = 16
"""So many runs of each recipe with the second seed were known when the constants were set; the later ones were not."""
Found = Callable[[Piece], Arrays | None]
"""The arrays of a piece; None where it has not been made."""


@dataclass(frozen=True, kw_only=True)
class RecipeRun:
    """One run of a recipe with the seed of a set of runs, `fit` or `check`."""

    recipe: str
    use: str
    index: int
    shorten: Shorten

    @property
    def name(self) -> str:
        """Recipe, seed and number of the run."""
        return f"{self.recipe}, seed {SEEDS[self.use]}, run {self.index}"

    def piece(self, steps_per_turn: int) -> Piece:
        """The piece that runs it with so many steps a turn; there are no sensors, which could raise them."""
        return run_piece(with_operation(self.scenario, steps_per_turn=steps_per_turn))

    @property
    def scenario(self) -> Scenario:
        """The scenario with the steps of the recipe."""
        return self.shorten(_recipe(self.recipe, SEEDS[self.use]).scenario(self.index))


@dataclass(frozen=True, kw_only=True)
class Halved:
    """The motions of a rubbing run with 1,024 and with 2,048 steps a turn."""

    run: RecipeRun
    whole: Motions
    half: Motions

    @property
    def kept(self) -> bool:
        """Whether class and period are the same."""
        return self.whole.system == self.half.system

    @property
    def confidence(self) -> float:
        """`motion_confidence` with 1,024 steps."""
        return self.whole.system.confidence


def all_runs(runs: int, shorten: Shorten) -> list[RecipeRun]:
    """The runs of the study, in an order in which any first part of them has all recipes and both seeds."""
    return [
        RecipeRun(recipe=recipe, use=use, index=index, shorten=shorten)
        for index in range(runs)
        for use in SEEDS
        for recipe in RECIPES
    ]


def halved(found: Found, runs: Sequence[RecipeRun]) -> list[Halved]:
    """The runs that rub with 1,024 steps and are finished with both steps."""
    return list(_halved(found, runs))


def _halved(found: Found, runs: Sequence[RecipeRun]) -> Iterator[Halved]:
    for run in runs:
        whole = found(run.piece(STEPS))
        if whole and rubs(whole):
            half = found(run.piece(2 * STEPS))
            if half and rubs(half):
                yield Halved(run=run, whole=motions(whole), half=motions(half))


def rubbing(found: Found, runs: Sequence[RecipeRun]) -> list[RecipeRun]:
    """The finished runs that rub: only they are run with half the step."""
    return [run for run in runs if (whole := found(run.piece(STEPS))) and rubs(whole)]


def motions(kept: CompactRecord) -> Motions:
    """The class of a kept run and its indicators, by the present rules."""
    response = response_of(kept)
    return motion(response, lyapunov(response.companion_growth))


@cache
def _recipe(name: str, seed: int) -> Recipe:
    data = tomllib.loads(RECIPE.format(runs=1000)) if name == "thousand" else read_toml(FOLDER / f"{name}.toml")
    return parse_recipe({**data, "seed": seed}, folder=FOLDER)
