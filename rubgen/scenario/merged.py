"""The recipe of a merged set: the recipes of its sources, whose runs follow each other."""

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import replace

from pydantic import PrivateAttr

from rubgen.errors import UserError
from rubgen.scenario.recipe import Recipe
from rubgen.scenario.scenario import Merged, Scenario


class MergedRecipe(Recipe):
    """Several recipes with the same columns.

    The first runs are those of the first recipe, then follow those of the second. All other keys have the values of the
    first recipe; `name` and `runs` belong to the merged set.
    """

    _sources: tuple[tuple[int, Recipe], ...] = PrivateAttr(default=())
    _digits: tuple[str, ...] = PrivateAttr(default=())

    @property
    def sources(self) -> tuple[tuple[int, Recipe], ...]:
        """The recipes of the merged sets, each with the number of its first run in the merged set before it."""
        return self._sources

    def own(self, index: int) -> tuple[int, int]:
        """Return the number of the source of run `index`, and the run's number in this source.

        Raises UserError for a number that is not a run of the merged set.
        """
        if not 0 <= index < self.runs:
            raise UserError(f"index = {index!r:.100}: give the number of a run, from 0 to {self.runs - 1:,}")
        number = bisect_right(self._sources, index, key=lambda each: each[0]) - 1
        return number, index - self._sources[number][0]

    def scenario(self, index: int, *, screened: bool = True) -> Scenario:
        """Draw run number `index` as its source draws it.

        The scenario has the run's name in the merged set, but its own `index` in the source. `screened` is as in
        `Recipe.scenario`: with False no candidates of a balance are simulated. Raises UserError as `own` does.
        """
        number, own = self.own(index)
        return replace(self._sources[number][1].scenario(own, screened=screened), merged=self.origin(index))

    def origin(self, index: int) -> Merged:
        """Return the source of run number `index`: its digits, and the number of its first run in the merged set.

        Raises UserError as `own` does.
        """
        number, _ = self.own(index)
        return Merged(source=self._digits[number], first=self._sources[number][0])

    def split_of(self, index: int) -> str:
        """Return the split of run number `index` in its source. Raises UserError as `own` does."""
        number, own = self.own(index)
        return self._sources[number][1].split_of(own)

    def named_parts(self, source: str = "") -> Iterator[tuple[str, Recipe]]:
        """Yield each different recipe of the sources' splits, after its name in messages. It begins with `source`."""
        for _, recipe in self._sources:
            yield from recipe.named_parts(source)


def merged_recipe(whole: Recipe, sources: Sequence[Recipe], digits: Sequence[str]) -> MergedRecipe:
    """Return the recipe of a merged set.

    - whole: the recipe of the first source, with the name and the number of runs of the merged set.
    - sources: the recipes of the sources, in the order of their runs.
    - digits: the digits of a digest that name each source, as in the column `merged_from`.
    """
    recipe = MergedRecipe(**{key: getattr(whole, key) for key in whole.model_fields_set})
    recipe._folder, recipe._machines, recipe._sensor_sets = whole._folder, whole._machines, whole._sensor_sets
    recipe._checked, recipe._digits = True, tuple(digits)
    firsts = [sum(each.runs for each in sources[:number]) for number in range(len(sources))]
    recipe._sources = tuple(zip(firsts, sources, strict=True))
    return recipe
