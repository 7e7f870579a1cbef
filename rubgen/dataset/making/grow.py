"""Let a finished set grow: its shards count as closed, and the last one of each split is opened again."""

from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

import pyarrow as pa

from rubgen.dataset.files import write_json
from rubgen.dataset.layout import Layout
from rubgen.dataset.making.close import ClosedShard
from rubgen.dataset.making.keep import Keeper
from rubgen.dataset.manifest import FileEntry, Manifest, read_derived
from rubgen.dataset.rows import RunTable, asked_bytes
from rubgen.dataset.shards import Shard, shards_of
from rubgen.dataset.tables import RUNS, SetTable, tables_of
from rubgen.errors import UserError
from rubgen.formats import run_formats
from rubgen.io.parquet.read import row_groups
from rubgen.io.parquet.write import write_table
from rubgen.scenario import Recipe
from rubgen.scenario.run_id import index_of


def prepare_growth(layout: Layout, before: Manifest, recipe: Recipe) -> None:
    """Fill the staging folder of `layout` with the runs of the finished set there, so that more runs can be added.

    - layout: paths of the set. Its files stay as they are.
    - before: its manifest.
    - recipe: the recipe with more runs.

    A shard that stays as it is counts as closed, with the digests of the manifest; its files are not read. Runs of a
    shard that gets more runs are kept again, from its tables. Raises UserError where a file that is read is missing or
    damaged.
    """
    old = before.identity.recorded(str(layout.manifest))
    listed = {entry.path: entry for entry in before.files}
    listed |= read_derived(layout) if before.derived else {}
    runs = RunTable(layout.runs)
    partial = {shard.name: len(shard.indexes) for shard in shards_of(recipe) if not shard.full}
    for shard in shards_of(old):
        rows = runs.rows(shard.indexes).cast(RUNS.schema(old))
        try:
            if shard.full or partial.get(shard.name) == len(shard.indexes):
                _as_closed(layout, old, shard, rows, listed)
            else:
                _as_kept(layout, old, shard, rows)
        except LookupError as error:
            raise UserError(f"{layout.manifest}: lists no {error.args[0]}; check the set: rubgen verify") from None


def _as_closed(layout: Layout, recipe: Recipe, shard: Shard, rows: pa.Table, listed: dict[str, FileEntry]) -> None:
    """Write the rows and the record of a shard that stays as it is."""
    formats = recipe.output.formats
    write_table([rows], rows.schema, layout.staged(RUNS.name, shard.name))
    good = [row["run_id"] for row in _facts(rows) if row["status"] == "ok"]
    exports = {
        remade: [listed[_inner(layout, layout.export(each.name, run_id))] for run_id in good for each in chosen]
        for remade in (False, True)
        for chosen in [[each for each in run_formats(formats) if bool(each.remake) == remade]]
    }
    record = ClosedShard(
        runs=len(shard.indexes),
        status=dict(sorted(Counter(row["status"] for row in _facts(rows)).items())),
        tables=tuple(listed[_inner(layout, layout.shard(table.name, shard.name))] for table in tables_of(formats)),
        exports=tuple(exports[False]),
        derived=tuple(exports[True]),
    )
    write_json(layout.closed(shard.name), record.model_dump(mode="json"))


def _as_kept(layout: Layout, recipe: Recipe, shard: Shard, rows: pa.Table) -> None:
    """Keep the rows of a shard that gets more runs, as if its runs had just finished."""
    keeper = Keeper(layout, shard.name, "before")
    asked = asked_bytes(recipe)
    ok = [facts["run_id"] for facts in _facts(rows) if facts["status"] == "ok"]
    tables = [
        _each_run(layout.shard(table.name, shard.name), table, table.schema(recipe), asked, ok)
        for table in tables_of(recipe.output.formats)
    ]
    for number, facts in enumerate(_facts(rows)):
        others = [next(table) if facts["status"] == "ok" else None for table in tables]
        keeper.keep(index_of(facts["run_id"]), [rows.slice(number, 1), *others])


def _each_run(path: Path, table: SetTable, types: pa.Schema, asked: float, runs: Sequence[str]) -> Iterator[pa.Table]:
    """Yield the rows of each of these runs in a file, in order. Rows of one run are in one row group."""
    groups = row_groups(path, asked)
    left = types.empty_table()
    for run_id in runs:
        if not left.num_rows:
            left = next(groups, left)
        names = left["run_id"].to_pylist()
        count = next((place for place, name in enumerate(names) if name != run_id), len(names))
        if count != 1 and not table.several:
            raise UserError(f"{path}: {run_id} lacks a row; check the set: rubgen verify")
        yield left.slice(0, count)
        left = left.slice(count)


def _facts(rows: pa.Table) -> list[dict[str, str]]:
    facts: list[dict[str, str]] = rows.select(["run_id", "status"]).to_pylist()
    return facts


def _inner(layout: Layout, path: Path) -> str:
    return path.relative_to(layout.root).as_posix()
