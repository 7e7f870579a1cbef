"""Make a data set from a recipe. Every run is made once, even where the work is interrupted."""

from collections.abc import Iterable, Mapping
from contextlib import AbstractContextManager, suppress
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from rubgen.dataset.card import write_card
from rubgen.dataset.checking.verify import advice, findings
from rubgen.dataset.croissant import write_croissant
from rubgen.dataset.layout import Layout
from rubgen.dataset.making.assemble import assemble
from rubgen.dataset.making.claim import begun, claimed, finished, has_remains, remove_staging
from rubgen.dataset.making.outcome import Outcome, outcome_of
from rubgen.dataset.making.stage import is_staged, stage_run, warm_up, warming_up
from rubgen.dataset.making.workers import unordered, usable_cores, worker_pool
from rubgen.dataset.manifest import Identity, identity_of, read_manifest, write_manifest
from rubgen.dataset.rows import asked_bytes
from rubgen.errors import UserError, warn, write_problems
from rubgen.io.columns import signal_columns
from rubgen.progress import Report, count, shown, step
from rubgen.scenario import Recipe, load_recipe, parse_recipe
from rubgen.scenario.load import check_recipe, checked_runs

KEPT = "finished runs are kept"
LOOKED_AT, MACHINES = 16, 4
"""Numbers of first runs and machines of which one must be able to rub. Where none can, runs rub rarely at best."""


@dataclass(frozen=True, kw_only=True)
class Generated:
    """The result of `generate`."""

    directory: Path
    """Directory of the set."""
    runs: int
    """Number of its runs."""
    made: int
    """Number of runs made by this call."""
    status: dict[str, int]
    """Number of runs by status."""
    outcome: Outcome
    """Counts of rub and classes of motion, and reasons of failures."""
    verified: bool = False
    """True where the set was finished before and this call verified it."""


def generate(
    recipe: Recipe | Mapping[str, object] | Path | str | None,
    out: Path | str,
    *,
    runs: int | None = None,
    workers: int | None = None,
    progress: Report | bool | None = None,
) -> Generated:
    """Make the data set of a recipe in a directory.

    - recipe: a recipe, its TOML values, its file, or None for the default recipe.
    - out: the directory.
    - runs: overrides the recipe's number of runs. The number belongs to the recipe: another number is another data set
      and needs another directory.
    - workers: number of processes, by default one for each usable core; 1 works in this process.
    - progress: called with the numbers of finished and of all runs. True shows them on stderr, None only on a terminal
      or in a notebook.

    Each run is simulated alone and stored as soon as it is finished. The same call after an interruption makes the
    missing runs, with the same bytes. Failed runs are listed with their reason. A finished set is verified and not
    changed.

    Works from a script without a main guard, a notebook, a pipe or a thread: workers do not import the main module.
    Raises UserError, one line, for bad input, a directory with other content or not writable, and a full disk;
    RubgenError where a worker process dies or the system fails elsewhere.
    """
    recipe = _recipe(recipe, runs)
    workers = _workers(workers)
    signal_columns(recipe.sensing.set, clean=recipe.sensing.keep_clean)  # refuses names that columns have
    layout, identity = Layout(out), identity_of(recipe)
    with write_problems(layout.root, advice="give a directory that you may write to", kept=KEPT):
        if not finished(layout, identity):
            with claimed(layout, identity):
                if not finished(layout, identity):  # another rubgen may have done it meanwhile
                    return _make(recipe, layout, identity, workers, progress)
        with _shown(progress), step("verify the set"):
            return _nothing_to_do(layout, identity)


def _recipe(recipe: Recipe | Mapping[str, object] | Path | str | None, runs: int | None) -> Recipe:
    if isinstance(recipe, Mapping):
        return parse_recipe(dict(recipe), runs=runs)
    if not isinstance(recipe, Recipe):
        return load_recipe(recipe, runs=runs)
    chosen = recipe if runs is None else recipe.model_copy(update={"runs": checked_runs(runs)})
    check_recipe(chosen)
    return chosen


def _workers(workers: int | None) -> int:
    if workers is not None and (isinstance(workers, bool) or not isinstance(workers, int) or workers < 1):
        raise UserError(f"--workers {workers}: must be at least 1; give a number of processes")
    return workers or usable_cores()


def _make(
    recipe: Recipe, layout: Layout, identity: Identity, workers: int, progress: Report | bool | None
) -> Generated:
    with begun(layout, identity):
        with _shown(progress):
            made = _make_missing(recipe, layout, workers, progress if callable(progress) else None)
        status = dict(sorted(assemble(recipe, layout).items()))
        write_card(layout, identity, status)
        write_croissant(layout, identity)
        write_manifest(layout, identity, status)
    remove_staging(layout)
    return Generated(directory=layout.root, runs=recipe.runs, made=made, status=status, outcome=outcome_of(layout))


def _nothing_to_do(layout: Layout, identity: Identity) -> Generated:
    found = findings(layout.root)
    if found:
        raise UserError(f"{found[0].text} ({len(found)} problems in all); {advice(layout.root, found)}")
    if has_remains(layout):
        with suppress(OSError, UserError), claimed(layout, identity):  # it may be in use, or read-only
            remove_staging(layout)
    manifest = read_manifest(layout)
    return Generated(
        directory=layout.root,
        runs=manifest.runs,
        made=0,
        status=manifest.status,
        outcome=outcome_of(layout),
        verified=True,
    )


def _make_missing(recipe: Recipe, layout: Layout, workers: int, progress: Report | None) -> int:
    formats = recipe.output.formats
    asked = asked_bytes(recipe)
    missing = [index for index in range(recipe.runs) if not is_staged(layout, index, formats, asked)]
    jobs = ((recipe.scenario(index), layout.root.resolve(), formats) for index in missing)
    done = recipe.runs - len(missing)
    if progress:
        progress(done, recipe.runs)
    if not missing:
        return 0
    looked_at = min(
        recipe.runs, LOOKED_AT, recipe.machines.runs_per_machine * MACHINES if recipe.machines else LOOKED_AT
    )
    first_runs = tuple(recipe.scenario(index) for index in range(looked_at))
    corners = () if recipe.machines else tuple(recipe.corners())  # each virtual machine is checked when it is drawn
    first = recipe.scenario(missing[0]), corners, first_runs
    with worker_pool(min(workers, len(missing))) as pool:
        with warming_up(), recipe.machine_named():
            remarks = list(unordered(pool, 1, warm_up, [first]))
        for remark in chain.from_iterable(remarks):
            warn(remark)
        _see_end(unordered(pool, workers, stage_run, jobs), done, recipe.runs, progress)
    return len(missing)


def _see_end(ended: Iterable[str], done: int, runs: int, progress: Report | None) -> None:
    """Report every run that ends. `done` runs were finished before."""
    with step("simulate", "runs", long=True):
        count(done, runs)
        for now, _status in enumerate(ended, start=done + 1):
            count(now, runs)
            if progress:
                progress(now, runs)


def _shown(progress: Report | bool | None) -> AbstractContextManager[None]:
    return shown(progress if isinstance(progress, bool) or progress is None else False)
