"""Labelled runs in memory, one after the other, without files."""

from collections.abc import Iterator, Mapping
from itertools import count
from pathlib import Path

from rubgen.errors import RubgenError, UserError
from rubgen.pipeline import Run, refused, simulate
from rubgen.scenario import Recipe, load_recipe, parse_recipe
from rubgen.scenario.load import check_recipe

MOST_FAILED = 64
"""How many runs may fail one after the other."""


def stream(recipe: Recipe | Mapping[str, object] | Path | str | None = None) -> Iterator[Run]:
    """Simulate the runs of a recipe without end and yield each run in memory, for training without files.

    - recipe: a recipe, its TOML values, its file, or None for the default recipe. Its number of runs is ignored.

    They are the runs of the data set that `generate` makes of the recipe, in the order of their numbers: run i has the
    same recording and labels. Failed runs are left out. This process makes the runs, one at a time; memory of a run is
    freed when the caller drops it. Raises UserError for a recipe that is not allowed, at the call; RubgenError where 64
    runs fail one after the other, with the reason of the last run.
    """
    if isinstance(recipe, Recipe):
        check_recipe(recipe)
        chosen = recipe
    else:
        chosen = parse_recipe(dict(recipe)) if isinstance(recipe, Mapping) else load_recipe(recipe)
    return _good_runs(chosen)


def _good_runs(recipe: Recipe) -> Iterator[Run]:
    failed = 0
    for index in count():
        run = _run(recipe, index)
        if run.labels is not None:
            failed = 0
            yield run
            continue
        failed += 1
        if failed == MOST_FAILED:
            reason = f"{run.response.status.code}: {run.response.reason}"
            raise RubgenError(
                f"{recipe.name}: {failed} runs failed one after the other; {run.scenario.run_id} {reason}"
            )


def _run(recipe: Recipe, index: int) -> Run:
    scenario = recipe.scenario(index)
    try:
        return simulate(scenario)
    except UserError as error:  # not possible with the drawn values
        return refused(scenario, str(error))
