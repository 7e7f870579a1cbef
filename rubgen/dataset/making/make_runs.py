"""Make the runs of a shard, keep each as it finishes, and close the shard. A worker process does this."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from rubgen.dataset.layout import Layout
from rubgen.dataset.making.keep import Keeper, kept_runs, runs_of_session
from rubgen.dataset.manifest import read_identity
from rubgen.dataset.rows import RunTable, remember
from rubgen.dataset.tables import RUNS, tables_of
from rubgen.errors import RubgenError, UserError
from rubgen.formats import run_formats
from rubgen.io.parquet.words import with_words
from rubgen.scenario import Recipe
from rubgen.scenario.run_id import run_id_of

if TYPE_CHECKING:  # Run carries the solver's imports; this module is imported by commands that simulate nothing
    from rubgen.pipeline import Run

ALONE = "from rubgen.dataset.making.make_runs import make_one; make_one({root!r}, {shard!r}, {session!r}, {index})"


@lru_cache(maxsize=1)
def recipe_of(root: Path, _begun: int) -> Recipe:
    """Return the recipe of the unfinished set in `root`.

    The result is cached; `_begun` distinguishes sets made there.
    """
    return read_identity(Layout(root)).recorded()


def recipe_at(root: Path) -> Recipe:
    """Return the recipe of the unfinished set in `root`, with its recorded machine and sensors."""
    return recipe_of(root, Layout(root).identity.stat().st_mtime_ns)


def make_runs(root: Path, shard: str, session: str, indexes: tuple[int, ...]) -> int:
    """Make runs of an open shard and keep each run as it finishes. A worker process calls it.

    Returns the number of `indexes`. Runs that this session kept already are skipped: a lost job is submitted again. A
    run during which a worker of this session died is made in a separate process. If that process dies too, the run is
    recorded as failed. Raises RubgenError where that process ends with an exception of Python.

    - root: directory of the set.
    - shard: name of the shard.
    - session: name of the call of `generate` for which the runs are made.
    - indexes: numbers of the runs.
    """
    layout, recipe = Layout(root), recipe_at(root)
    kept, suspected = runs_of_session(layout, shard, session)
    keeper = Keeper(layout, shard, session)
    if layout.decided.exists():
        for index, row in zip(indexes, with_words(RunTable(layout.decided).rows(indexes)).to_pylist(), strict=True):
            remember(recipe, index, row)
    for index in indexes:
        if index in kept:
            continue
        if index in suspected:
            _make_alone(layout, recipe, shard, session, index)
        else:
            _make(layout, recipe, keeper, index)
    return len(indexes)


def make_one(root: str, shard: str, session: str, index: int) -> None:
    """Make one run in this process and keep it, as `make_runs` does.

    The process ends when its standard input is closed.
    """
    threading.Thread(target=_end_with_input, daemon=True).start()
    layout = Layout(root)
    _make(layout, recipe_at(layout.root), Keeper(layout, shard, session), index)


def _end_with_input() -> None:
    """End this process when its standard input ends: a worker that is killed leaves no process behind it."""
    while os.read(0, 1):
        pass
    os._exit(1)


def _make(layout: Layout, recipe: Recipe, keeper: Keeper, index: int) -> None:
    """Simulate one run, write its own files, and keep its rows. A run that its values forbid is kept as refused."""
    keeper.begin(index)
    _keep(layout, recipe, keeper, simulated(recipe, index))


def simulated(recipe: Recipe, index: int) -> Run:
    """Simulate run number `index` of a recipe. A run whose drawn values are not possible has the status refused."""
    from rubgen.pipeline import refused, simulate

    scenario = recipe.scenario(index)
    try:
        return simulate(scenario)
    except UserError as error:
        return refused(scenario, str(error))


def _keep(layout: Layout, recipe: Recipe, keeper: Keeper, run: Run) -> None:
    formats, split = recipe.output.formats, recipe.split_of(run.scenario.number)
    for each in run_formats(formats):
        path = layout.export(each.name, run.scenario.run_id)
        if run.labels is not None:
            path.parent.mkdir(parents=True, exist_ok=True)
            each.write(run, path)
        else:
            path.unlink(missing_ok=True)  # of a try that was stopped
    tables = tables_of(formats)
    rows = [table.row(run, split) if run.labels is not None else None for table in tables]
    keeper.keep(run.scenario.number, [RUNS.row(run, split), *rows])


def _make_alone(layout: Layout, recipe: Recipe, shard: str, session: str, index: int) -> None:
    """Make a run in a process of its own. Where that ends without the run, keep the run as failed."""
    from rubgen.dataset.making.workers import how_ended
    from rubgen.pipeline import refused
    from rubgen.solver.response import Status

    call = ALONE.format(root=str(layout.root), shard=shard, session=session, index=index)
    pipe, nothing = subprocess.PIPE, subprocess.DEVNULL
    with subprocess.Popen(  # noqa: S603
        [sys.executable, "-c", call], stdin=pipe, stdout=nothing, stderr=pipe, text=True
    ) as alone:
        errors = alone.stderr.read() if alone.stderr else ""
        code = alone.wait()
    if code == 1:  # of an exception of Python, which is no fault of the run's
        raise RubgenError(f"{run_id_of(index)}: {errors.strip().rpartition(chr(10))[2] or 'cannot be made'}")
    if index not in kept_runs(layout, shard):
        reason = f"its worker process died, and so did a process for it alone, which {how_ended([code])}"
        run = refused(recipe.scenario(index, screened=False), reason, Status.DIED)
        _keep(layout, recipe, Keeper(layout, shard, session), run)
