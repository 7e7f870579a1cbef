"""Make damaged shards of a finished set again from its manifest, and put back what has the listed bytes."""

import shutil
from collections.abc import Iterable
from pathlib import Path
from uuid import uuid4

from rubgen.dataset.checking.inventory import REPAIRING
from rubgen.dataset.files import sha256_of, write_json
from rubgen.dataset.layout import Layout
from rubgen.dataset.making.claim import STAGED
from rubgen.dataset.making.close import read_closed
from rubgen.dataset.making.plan import MOST_RUNS_A_JOB, Plan, do
from rubgen.dataset.making.workers import unordered, usable_cores, worker_pool
from rubgen.dataset.manifest import Manifest, identity_of
from rubgen.dataset.shards import shards_of
from rubgen.progress import count, step
from rubgen.scenario import Recipe
from rubgen.scenario.run_id import run_id_of


def other_versions(manifest: Manifest) -> dict[str, tuple[str, str]]:
    """Return the packages of which another version is installed than made the set: by name, then and now."""
    before, now = manifest.identity.packages, identity_of(manifest.identity.recorded()).packages
    return {name: (before.get(name, "none"), now.get(name, "none")) for name in now if before.get(name) != now[name]}


def shards_with(recipe: Recipe, paths: Iterable[str]) -> set[str]:
    """Return the names of the shards to which these files of the set belong. `runs.parquet` belongs to none."""
    stems = {Path(path).stem for path in paths if "/" in path}
    return {
        shard.name
        for shard in shards_of(recipe)
        if shard.name in stems or not stems.isdisjoint(map(run_id_of, shard.indexes))
    }


def remake(layout: Layout, manifest: Manifest, wrong: set[str]) -> list[str]:
    """Simulate the runs of the shards of the `wrong` files again, and replace these files. Return their paths.

    A file is replaced only by the bytes that the manifest lists. The installed versions must be those of the set.
    """
    recipe = manifest.identity.recorded(str(layout.manifest))
    listed = {entry.path: entry.sha256 for entry in manifest.files}
    chosen = shards_with(recipe, wrong & listed.keys())
    if not chosen:
        return []
    inner = Layout(layout.root / REPAIRING)
    for name in STAGED:
        (inner.staging / name).mkdir(parents=True, exist_ok=True)
    write_json(inner.identity, manifest.identity.model_dump(mode="json"))
    plan = Plan(recipe, inner, uuid4().hex[:12], only=frozenset(chosen))
    with (
        worker_pool(min(usable_cores(), max(1, plan.missing // MOST_RUNS_A_JOB))) as pool,
        step("simulate", "runs", long=True),
    ):
        done = plan.done
        for shard, made in unordered(pool, do, plan.jobs(pool.number if pool else 1)):
            if made:
                plan.ended(shard)
            done += made
            count(done, plan.total)
    made_again = [path for name in sorted(chosen) for path in _put_back(layout, inner, name, wrong, listed)]
    shutil.rmtree(inner.root)
    return made_again


def _put_back(layout: Layout, inner: Layout, shard: str, wrong: set[str], listed: dict[str, str]) -> list[str]:
    record = read_closed(inner, shard)
    found = []
    for entry in (*record.tables, *record.exports):
        table = Path(entry.path).parts[0]
        staged = inner.staged(table, shard)
        source = staged if staged.exists() and Path(entry.path).stem == shard else inner.root / entry.path
        if entry.path in wrong and sha256_of(source) == listed.get(entry.path):
            (layout.root / entry.path).parent.mkdir(parents=True, exist_ok=True)
            source.replace(layout.root / entry.path)
            found.append(entry.path)
    return found
