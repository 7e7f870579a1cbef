"""Close a shard: its kept runs become one file of each table, with hashes. A worker process does this."""

from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path

import pyarrow as pa
from pydantic import NonNegativeInt

from rubgen.dataset.files import sha256_of, write_json
from rubgen.dataset.layout import RUNS_PER_ROW_GROUP, Layout
from rubgen.dataset.making.keep import Kept, kept_runs, remove_kept, rows_of
from rubgen.dataset.making.make_runs import recipe_at
from rubgen.dataset.manifest import FileEntry, entry_of
from rubgen.dataset.shards import Shard
from rubgen.dataset.tables import RUNS, SetTable, tables_of
from rubgen.errors import RubgenError
from rubgen.formats import run_formats
from rubgen.io.files import read_json
from rubgen.io.parquet.write import write_table
from rubgen.machine.quantities import StrictModel
from rubgen.scenario import Recipe
from rubgen.scenario.run_id import run_id_of


class ClosedShard(StrictModel):
    """The record of a closed shard: numbers of its runs, and the digests of its files for the manifest."""

    runs: NonNegativeInt
    status: dict[str, NonNegativeInt]
    tables: tuple[FileEntry, ...]
    """Its file of each table, in the order of the tables."""
    exports: tuple[FileEntry, ...]
    """Files of its single runs."""
    derived: tuple[FileEntry, ...]
    """Files of its single runs that can be made again."""


def close_shard(root: Path, shard: Shard) -> None:
    """Write the tables of a shard whose runs are all kept, then its record. Remove the kept rows.

    - root: directory of the set.
    - shard: the shard. Nothing is done if it is closed already.

    Raises RubgenError where a run is not kept, or its kept rows are damaged.
    """
    layout = Layout(root)
    if layout.closed(shard.name).exists():  # by a worker that died before it could say so
        return
    recipe = recipe_at(root)
    kept = kept_runs(layout, shard.name)
    lost = [index for index in shard.indexes if index not in kept]
    if lost:
        raise RubgenError(f"{run_id_of(lost[0])}: what was kept of it is damaged; the same command makes it anew")
    ordered = [kept[index] for index in shard.indexes]
    status = _write_tables(layout, recipe, shard, ordered)
    write_closed(layout, recipe, shard, status, [run_id_of(i) for i in shard.indexes if kept[i].good])
    remove_kept(layout, shard.name)


def write_closed(layout: Layout, recipe: Recipe, shard: Shard, status: dict[str, int], good: list[str]) -> None:
    """Hash the files of a shard and write its record. All these files must exist: its tables, and files of single runs.

    - status: number of the shard's runs by status.
    - good: names of its runs with status ok; only these have files of single runs.
    """
    formats = recipe.output.formats
    exports = {remake: _exports(layout, formats, good, remade=remake) for remake in (False, True)}
    record = ClosedShard(
        runs=len(shard.indexes),
        status=status,
        tables=tuple(_table_entry(layout, table, shard) for table in tables_of(formats)),
        exports=tuple(entry_of(path, layout.root) for path in exports[False]),
        derived=tuple(entry_of(path, layout.root) for path in exports[True]),
    )
    write_json(layout.closed(shard.name), record.model_dump(mode="json"))


def read_closed(layout: Layout, shard: str) -> ClosedShard:
    """Read the record of a closed shard.

    Raises RubgenError where it is missing or damaged; a damaged record is deleted.
    """
    path = layout.closed(shard)
    try:
        return ClosedShard.model_validate(read_json(path.read_bytes()))
    except (FileNotFoundError, ValueError):  # a ValidationError is a ValueError
        path.unlink(missing_ok=True)
        raise RubgenError(f"{path}: damaged: give the same command again, it makes this shard anew") from None


def _write_tables(layout: Layout, recipe: Recipe, shard: Shard, ordered: list[Kept]) -> dict[str, int]:
    """Write the file of each table. Return the number of runs by status."""
    status: Counter[str] = Counter()
    formats = recipe.output.formats
    for table in (RUNS, *tables_of(formats)):
        types = table.schema(recipe)
        rows = rows_of(ordered, table, types, formats)
        size = len(ordered) if table is RUNS else RUNS_PER_ROW_GROUP
        write_table(
            _groups(rows, size, types, status if table is RUNS else Counter()),
            types,
            layout.staged(table.name, shard.name),
        )
    return dict(sorted(status.items()))


def _groups(rows: Iterable[pa.RecordBatch], size: int, types: pa.Schema, status: Counter[str]) -> Iterator[pa.Table]:
    remaining = iter(rows)
    while group := list(islice(remaining, size)):
        table = pa.Table.from_batches(group, types).combine_chunks()
        if "status" in types.names:
            status.update(table["status"].to_pylist())
        yield table


def _table_entry(layout: Layout, table: SetTable, shard: Shard) -> FileEntry:
    staged = layout.staged(table.name, shard.name)
    path = layout.shard(table.name, shard.name).relative_to(layout.root).as_posix()
    return FileEntry(path=path, bytes=staged.stat().st_size, sha256=sha256_of(staged))


def _exports(layout: Layout, formats: Iterable[str], good: list[str], *, remade: bool) -> list[Path]:
    chosen = [each for each in run_formats(formats) if bool(each.remake) == remade]
    return [layout.export(each.name, name) for each in chosen for name in good]
