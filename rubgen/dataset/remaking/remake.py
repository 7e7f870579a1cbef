"""Make damaged shards of a finished set again from its manifest, and replace the files whose listed bytes result."""

import shutil
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from uuid import uuid4

import pyarrow as pa

from rubgen.dataset.checking.inventory import REPAIRING
from rubgen.dataset.files import sha256_of, write_json
from rubgen.dataset.layout import Layout
from rubgen.dataset.making.claim import STAGED
from rubgen.dataset.making.close import read_closed
from rubgen.dataset.making.finish import write_runs
from rubgen.dataset.making.plan import MOST_RUNS_A_JOB, PartOfSet, Plan, do
from rubgen.dataset.making.workers import unordered, usable_cores, worker_pool
from rubgen.dataset.manifest import Manifest, identity_of
from rubgen.dataset.rows import RunTable
from rubgen.dataset.shards import Shard, shards_of
from rubgen.dataset.tables import RUNS
from rubgen.errors import UserError
from rubgen.io.parquet.write import write_table
from rubgen.progress import count, step
from rubgen.scenario import Recipe
from rubgen.scenario.run_id import run_id_of


def other_versions(manifest: Manifest) -> dict[str, tuple[str, str]]:
    """Return the packages whose installed version is not the set's: by name, the set's and the installed version.

    A package for which the manifest has no version has "none" as the set's.
    """
    before, now = manifest.identity.packages, identity_of(manifest.identity.recorded()).packages
    return {name: (before.get(name, "none"), now.get(name, "none")) for name in now if before.get(name) != now[name]}


def shards_with(recipe: Recipe, paths: Iterable[str]) -> set[str]:
    """Return the names of the shards to which the files at `paths`, relative to the set, belong.

    A file belongs to a shard if it has the name of the shard, or of one of its runs. Files outside of folders, such as
    `runs.parquet`, belong to no shard.
    """
    stems = {Path(path).stem for path in paths if "/" in path}
    return {
        shard.name
        for shard in shards_of(recipe)
        if shard.name in stems or not stems.isdisjoint(map(run_id_of, shard.indexes))
    }


def remake(layout: Layout, manifest: Manifest, wrong: set[str], *, trusting: bool = True) -> list[str]:
    """Simulate the runs of damaged or missing files again, and replace these files. Return their paths, sorted.

    - wrong: paths of the files, relative to the set. Paths that the manifest does not list are ignored.
    - trusting: whether rows that can still be read from a damaged `runs.parquet` are used.

    All runs of the files' shards (`shards_with`) are simulated. For `runs.parquet` they are all runs of the shards
    whose rows cannot be read; without `trusting`, all runs of the set. If this does not restore the listed bytes of
    `runs.parquet`, all runs are simulated. A file is replaced only by the bytes that the manifest lists. Where they are
    not restored, the file is left as it is, and is not in the result. The installed package versions must be the same
    as in the set (`other_versions`); this is not checked.
    """
    recipe = manifest.identity.recorded(str(layout.manifest))
    listed = {entry.path: entry.sha256 for entry in manifest.files}
    wanted = wrong & listed.keys()
    rows = _Rows(layout.runs if trusting else None, recipe) if layout.runs.name in wanted else None
    chosen = shards_with(recipe, wanted) | (rows.lost() if rows else set())
    if not chosen and not rows:
        return []
    inner = Layout(layout.root / REPAIRING)
    for name in STAGED:
        (inner.staging / name).mkdir(parents=True, exist_ok=True)
    write_json(inner.identity, manifest.identity.model_dump(mode="json"))
    plan = Plan(PartOfSet(recipe, inner, only=frozenset(chosen)), uuid4().hex[:12])
    putting = _PuttingBack(layout, inner, wanted, listed)
    for name in chosen:
        putting.files_of(name)  # of shards that were closed before a stop
    with (
        worker_pool(min(usable_cores(), max(1, plan.missing // MOST_RUNS_A_JOB))) as pool,
        step("simulate", "runs", long=True),
    ):
        done = plan.done
        for shard, made in unordered(pool, do, plan.jobs(pool.number if pool else 1)):
            if made:
                plan.ended(shard)
            else:
                putting.files_of(shard.name)
            done += made
            count(done, plan.total)
    if rows:
        putting.runs(rows, recipe)
    shutil.rmtree(inner.root)
    if rows and trusting and layout.runs.name not in putting.made:
        putting.made += remake(layout, manifest, {layout.runs.name}, trusting=False)
    return sorted(putting.made)


class _Rows:
    """The rows of a damaged `runs.parquet` that can still be read."""

    def __init__(self, path: Path | None, recipe: Recipe) -> None:
        """Open the file at `path`; without one no row can be read."""
        self._recipe, self._table = recipe, None
        with suppress(UserError):
            self._table = RunTable(path) if path else None

    def of(self, shard: Shard) -> pa.Table | None:
        """Return the rows of a shard; None where one cannot be read. A wrong value in them is found in the end."""
        names = list(map(run_id_of, shard.indexes))
        with suppress(UserError, pa.ArrowException, LookupError):
            rows = self._table.rows(shard.indexes).cast(RUNS.schema(self._recipe)) if self._table else None
            return rows if rows and rows["run_id"].to_pylist() == names else None
        return None

    def lost(self) -> set[str]:
        """Return the names of the shards whose rows cannot be read."""
        return {shard.name for shard in shards_of(self._recipe) if self.of(shard) is None}


class _PuttingBack:
    """Puts files that were made again where they belong, if they have the listed bytes, and drops all others."""

    def __init__(self, layout: Layout, inner: Layout, wanted: set[str], listed: dict[str, str]) -> None:
        self._layout, self._inner, self._wanted, self._listed = layout, inner, wanted, listed
        self.made: list[str] = []

    def files_of(self, shard: str) -> None:
        """Put back the files of a shard, if it is closed. Its rows of `runs` stay."""
        if not self._inner.closed(shard).exists():
            return
        record = read_closed(self._inner, shard)
        for entry in (*record.tables, *record.exports, *record.derived):
            staged = self._inner.staged(Path(entry.path).parts[0], shard)
            source = staged if Path(entry.path).stem == shard else self._inner.root / entry.path
            if source.exists():  # it was put back before a stop
                self._put(source, entry.path)
                source.unlink(missing_ok=True)

    def runs(self, rows: _Rows, recipe: Recipe) -> None:
        """Write `runs.parquet` from the readable rows and the rows that were made again, and put it back."""
        for shard in shards_of(recipe):
            staged = self._inner.staged(RUNS.name, shard.name)
            found = None if staged.exists() else rows.of(shard)
            if found is not None:
                write_table([found], found.schema, staged)
        whole = self._inner.staging / self._layout.runs.name
        write_runs(self._inner, recipe, whole)
        self._put(whole, self._layout.runs.name)

    def _put(self, source: Path, path: str) -> None:
        if path in self._wanted and sha256_of(source) == self._listed.get(path):
            (self._layout.root / path).parent.mkdir(parents=True, exist_ok=True)
            source.replace(self._layout.root / path)
            self.made.append(path)
