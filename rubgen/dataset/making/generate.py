"""Make a data set from a recipe. Every run is made once, even where the work is interrupted."""

import shutil
from collections.abc import Mapping
from contextlib import AbstractContextManager, suppress
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path
from uuid import uuid4

from rubgen.brief import counted
from rubgen.dataset.checking.inventory import size_findings
from rubgen.dataset.checking.verify import advice
from rubgen.dataset.layout import Layout
from rubgen.dataset.making.claim import begun, check_begun, claimed, finished, has_remains, remove_staging
from rubgen.dataset.making.cluster import SLURM, cluster, slurm
from rubgen.dataset.making.finish import finish_set
from rubgen.dataset.making.outcome import Outcome, outcome_of
from rubgen.dataset.making.plan import Part, PartOfSet, Plan, do, part_of
from rubgen.dataset.making.warm_up import warm_up, warming_up
from rubgen.dataset.making.workers import Pool, unordered, usable_cores, worker_pool
from rubgen.dataset.manifest import Identity, Manifest, identity_of, read_manifest
from rubgen.dataset.remote.making import RemoteMaking
from rubgen.dataset.shards import shards_of
from rubgen.errors import UserError, warn, write_problems
from rubgen.io.columns import signal_columns
from rubgen.io.places import is_url
from rubgen.progress import Report, count, shown, step
from rubgen.scenario import Recipe, load_recipe, parse_recipe
from rubgen.scenario.load import check_recipe, checked_runs
from rubgen.scenario.run_id import run_id_of

KEPT = "finished runs are kept"
BEGIN_S = 600.0
"""How long a part waits for another that begins the set: a large one that grows is read first."""
TRIES = 5
"""How often workers may die one after another without one run kept in between."""
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
    """True where the set was finished before. The sizes of its files are then those of the manifest."""
    part: str = ""
    """The part of the set that this call made, such as 17/200; the set is not complete. Empty for a whole set."""


def generate(
    recipe: Recipe | Mapping[str, object] | Path | str | None,
    out: Path | str,
    *,
    runs: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    shard: str | None = None,
    finish: bool = False,
    progress: Report | bool | None = None,
) -> Generated:
    """Make the data set of a recipe in a directory.

    - recipe: a recipe, its TOML values, its file, a name of `rubgen list`, or None for the default recipe.
    - out: the directory, or a URL such as s3://bucket/set. For a URL the set is made in the cache folder. Each closed
      shard is uploaded, the manifest last.
    - runs: number of runs in place of the recipe's. A larger number than before adds runs to a finished set.
    - workers: number of processes, by default one for each usable core; 1 works in this process.
    - scheduler: address of a Dask scheduler, whose workers make the runs; or "slurm" for jobs of SLURM, one a worker.
    - shard: "17/200" makes only part 17 of 200 of the runs. Other processes may make the other parts at the same time.
      The result of a part has empty `status` and no counts in `outcome`.
    - finish: make no run; complete the set from its parts. Raises UserError if a run is missing.
    - progress: called with the numbers of finished and of all runs. True shows them on stderr, None only on a terminal
      or in a notebook.

    Each run is simulated alone and stored as soon as it is finished. The same call after an interruption makes the
    missing runs, with the same bytes. Failed runs are listed with their reason. If the set is finished, only the digest
    of the manifest and the sizes of its files are checked; nothing is changed.

    Works from a script without a main guard, a notebook, a pipe or a thread: workers do not import the main module.
    Raises UserError, one line, for bad input, a directory with other content or not writable, and a full disk;
    RubgenError where worker processes die again and again or the system fails elsewhere.
    """
    return generate_as(
        recipe, out, runs=runs, workers=workers, scheduler=scheduler, shard=shard, finish=finish, progress=progress
    )


def generate_as(
    recipe: Recipe | Mapping[str, object] | Path | str | None,
    out: Path | str,
    *,
    decided: Path | None = None,
    runs: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    shard: str | None = None,
    finish: bool = False,
    progress: Report | bool | None = None,
) -> Generated:
    """Make a data set as `generate` does, with candidates of virtual machines and of balances that are given.

    `decided` is a `runs.parquet` with a row for each run, at the number of the run. The run takes the candidates of its
    row, and they are not checked again. None chooses them as `generate` does. With `shard`, `decided` is not used.
    Other arguments, result and errors are as in `generate`.
    """
    recipe = _recipe(recipe, runs)
    remote = RemoteMaking(str(out), shard or "") if is_url(out) else None
    task = _Task(
        recipe=recipe,
        layout=remote.layout if remote else Layout(out),
        remote=remote,
        identity=identity_of(recipe),
        workers=_workers(workers),
        scheduler=scheduler,
        part=None if shard is None else part_of(shard),
        finish=finish,
        decided=decided,
        progress=progress,
    )
    if finish and shard is not None:
        raise UserError(f"--finish: stands beside --shard {shard}; make all parts first, then give --finish alone")
    signal_columns(recipe.sensing.set, clean=recipe.sensing.keep_clean)  # refuses names that columns have
    layout, identity = task.layout, task.identity
    with write_problems(layout.root, advice="give a directory that you may write to", kept=KEPT):
        if remote:
            return _make_at_url(task, remote)
        if not finished(layout, identity):
            if task.part and (made := _make_part(task)):
                return made
            with claimed(layout, identity):
                if not finished(layout, identity):  # another rubgen may have done it meanwhile
                    return _make(task)
        with _shown(progress), step("look at the set"):
            return nothing_to_do(layout, identity)


@dataclass(frozen=True, kw_only=True)
class _Task:
    """What one call of `generate` is to do."""

    recipe: Recipe
    layout: Layout
    remote: RemoteMaking | None
    identity: Identity
    workers: int
    scheduler: str | None
    part: Part | None
    finish: bool
    decided: Path | None
    progress: Report | bool | None


def _recipe(recipe: Recipe | Mapping[str, object] | Path | str | None, runs: int | None) -> Recipe:
    if isinstance(recipe, Mapping):
        return parse_recipe(dict(recipe), runs=runs)
    if not isinstance(recipe, Recipe):
        return load_recipe(recipe, runs=runs)
    if len(recipe.sources) > 1:
        raise UserError(f"{recipe.name}: is the recipe of a merged set; generate its sources and merge them")
    chosen = recipe if runs is None else recipe.model_copy(update={"runs": checked_runs(runs)})
    check_recipe(chosen)
    return chosen


def _workers(workers: int | None) -> int:
    if workers is not None and (isinstance(workers, bool) or not isinstance(workers, int) or workers < 1):
        raise UserError(f"--workers {workers}: must be at least 1; give a number of processes")
    return workers or usable_cores()


def _make(task: _Task) -> Generated:
    recipe, layout = task.recipe, task.layout
    with begun(layout, task.identity):
        if task.decided:
            shutil.copyfile(task.decided, layout.decided)
        with _shown(task.progress):
            made = _make_missing(task)
        status = finish_set(recipe, layout, task.identity, moved=task.remote is not None)
        outcome = outcome_of(layout)
        if task.remote:
            task.remote.finish()
    remove_staging(layout)
    return Generated(directory=layout.root, runs=recipe.runs, made=made, status=status, outcome=outcome)


def _make_at_url(task: _Task, remote: RemoteMaking) -> Generated:
    """Make a set, or one part of it, whose place is a URL."""
    store = remote.store.layout
    if finished(store, task.identity):
        shutil.rmtree(task.layout.root, ignore_errors=True)  # of a stop at the very end
        manifest = read_manifest(store)
        remote.store.check_sizes(manifest)
        return _whole(store, manifest)
    if task.part and (shards := sum(1 for _ in shards_of(task.recipe))) < task.part.count:
        raise UserError(
            f"--shard {task.part}: the set has {counted(shards, 'shard')}, and parts at a URL cannot share one; give "
            f"at most {shards} parts, or a directory that all parts see"
        )
    with remote.folder():
        made = _make_part(task) if task.part else None
        if made is None:
            with claimed(task.layout, task.identity):
                made = _make(task)
    return replace(made, directory=store.root)


def _make_part(task: _Task) -> Generated | None:
    """Make one part of the set, beside other processes. Returns None where the set is finished meanwhile."""
    layout, identity = task.layout, task.identity
    if not layout.identity.exists():
        with claimed(layout, identity, wait_s=BEGIN_S):
            if finished(layout, identity):
                return None
            with begun(layout, identity):
                pass
    check_begun(layout, identity)
    with _shown(task.progress):
        made = _make_missing(task)
    nothing = Outcome(rub=0, no_rub=0, motion={}, failures=())
    return Generated(
        directory=layout.root, runs=task.recipe.runs, made=made, status={}, outcome=nothing, part=str(task.part)
    )


def nothing_to_do(layout: Layout, identity: Identity) -> Generated:
    """Compare the sizes of a finished set's files with its manifest, and return the set's `Generated`.

    Remains of an interrupted call are deleted. Raises UserError where a size differs or a file is missing.
    """
    manifest = read_manifest(layout)
    found = list(size_findings(layout, manifest))
    if found:
        raise UserError(f"{found[0].text} ({len(found)} problems in all); {advice(layout.root, found)}")
    if has_remains(layout, identity):
        with suppress(OSError, UserError), claimed(layout, identity):  # it may be in use, or read-only
            remove_staging(layout)
    return _whole(layout, manifest)


def _whole(layout: Layout, manifest: Manifest) -> Generated:
    return Generated(
        directory=layout.root,
        runs=manifest.runs,
        made=0,
        status=manifest.status,
        outcome=outcome_of(layout),
        verified=True,
    )


def _make_missing(task: _Task) -> int:
    """Make the runs that are missing of the set or of a part, and close its shards. Return the number of runs made."""
    recipe, layout = task.recipe, task.layout
    formats = tuple(recipe.output.formats)
    if task.remote:
        task.remote.begin(task.identity, formats)
    plan = Plan(PartOfSet(recipe, layout, task.part or Part()), uuid4().hex[:12])
    report = task.progress if callable(task.progress) else None
    if task.finish and plan.missing:
        raise UserError(
            f"--finish: {counted(plan.missing, 'run')} of {plan.total} are not made, the first is "
            f"{run_id_of(plan.first_missing)}; make its part with --shard, or leave out --finish"
        )
    if report:
        report(plan.done, plan.total)
    local = min(task.workers, max(1, plan.missing))
    chosen: AbstractContextManager[Pool | None] = worker_pool(local)
    if task.scheduler:
        slurm_workers = slurm(task.workers, layout.root) if task.scheduler == SLURM else None
        chosen = slurm_workers or cluster(task.scheduler, layout.root)
    with chosen as pool:
        if plan.missing:
            _warm_up(recipe, plan, pool)
        with step("simulate", "runs", long=True):
            done = plan.done
            count(done, plan.total)
            jobs = plan.jobs(pool.number if pool else 1)
            for shard, made in unordered(pool, do, jobs, tries=TRIES, progress=plan.kept_now):
                if not made:
                    if task.remote:
                        task.remote.put_shard(shard.name, formats)
                    continue
                plan.ended(shard)
                done += made
                count(done, plan.total)
                if report:
                    report(done, plan.total)
    return plan.missing


def _warm_up(recipe: Recipe, plan: Plan, pool: Pool | None) -> None:
    looked_at = min(
        recipe.runs, LOOKED_AT, recipe.machines.runs_per_machine * MACHINES if recipe.machines else LOOKED_AT
    )
    first_runs = tuple(recipe.scenario(index, screened=False) for index in range(looked_at))
    corners = () if recipe.machines else tuple(recipe.corners())  # each virtual machine is checked when it is drawn
    first = recipe.scenario(plan.first_missing, screened=False), corners, first_runs
    with warming_up(), recipe.machine_named():
        remarks = list(unordered(pool, warm_up, [first], tries=2))
    for remark in chain.from_iterable(remarks):
        warn(remark)


def _shown(progress: Report | bool | None) -> AbstractContextManager[None]:
    return shown(progress if isinstance(progress, bool) or progress is None else False)
