"""Finish a set whose shards are all closed: one table of all runs, files at their places, card, manifest."""

from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import numpy as np
import pyarrow as pa

from rubgen.arrays import IntArray
from rubgen.dataset.card import write_card
from rubgen.dataset.croissant import write_croissant
from rubgen.dataset.layout import Layout
from rubgen.dataset.making.close import ClosedShard, read_closed
from rubgen.dataset.manifest import FileEntry, Identity, entry_of, write_manifest
from rubgen.dataset.shards import shards_of
from rubgen.dataset.tables import RUNS, tables_of
from rubgen.errors import RubgenError, UserError
from rubgen.io.files import sync_directory
from rubgen.io.parquet.read import read_table
from rubgen.io.parquet.sensors import SENSORS_SCHEMA, sensors_table
from rubgen.io.parquet.write import write_table
from rubgen.scenario import Recipe
from rubgen.scenario.run_id import index_of

ROWS_PER_GROUP = 4096


def finish_set(recipe: Recipe, layout: Layout, identity: Identity, *, moved: bool = False) -> dict[str, int]:
    """Complete a set whose shards are all closed. Return the number of runs by status.

    It writes `runs.parquet`, moves the files of all shards to their final paths, and writes `sensors.parquet`, card,
    `croissant.json`, manifest and digests. `.staging` stays. With `moved` the shards' files are already in an object
    store and are not moved. ROWS_PER_GROUP rows are in memory at a time. A set to which runs are added stays as it was
    until its new files are complete. Raises RubgenError where a file of a closed shard is lost: its record is deleted,
    and the same command makes the shard's runs again.
    """
    whole = layout.staging / layout.runs.name
    write_runs(layout, recipe, whole)
    names = sorted(shard.name for shard in shards_of(recipe))
    closed = [read_closed(layout, name) for name in names]
    for path in (layout.digest, layout.manifest):
        path.unlink(missing_ok=True)
    if not moved:
        _move(layout, recipe, names)
    whole.replace(layout.runs)
    status = sum((Counter(each.status) for each in closed), Counter[str]())
    ordered = dict(sorted(status.items()))
    write_sensors(recipe, layout.sensors)
    write_card(layout, identity, ordered)
    write_croissant(layout, identity)
    sync_directory(layout.root)
    write_manifest(layout, identity, ordered, _files(layout, recipe, closed), _derived(closed))
    return ordered


def write_runs(layout: Layout, recipe: Recipe, path: Path) -> None:
    """Write `runs.parquet` to `path`, from the rows of all shards in the staging folder.

    Raises RubgenError where the rows of a shard are lost.
    """
    spans = sorted((shard.indexes[0], shard.indexes[-1], shard.name) for shard in shards_of(recipe))
    types = RUNS.schema(recipe)
    write_table(_in_order(layout, spans, recipe.runs, types), types, path)


def write_sensors(recipe: Recipe, path: Path) -> None:
    """Write `sensors.parquet`, the table of the recipe's sensors, to `path`."""
    write_table([sensors_table(recipe.sensing)], SENSORS_SCHEMA, path)


def _files(layout: Layout, recipe: Recipe, closed: list[ClosedShard]) -> list[FileEntry]:
    """Return the entries of the manifest: card, description, runs, the files of each table, those of single runs."""
    first = [entry_of(path, layout.root) for path in (layout.card, layout.croissant, layout.sensors, layout.runs)]
    tables = [each.tables[place] for place in range(len(tables_of(recipe.output.formats))) for each in closed]
    return [*first, *tables, *sorted((entry for each in closed for entry in each.exports), key=_path)]


def _derived(closed: list[ClosedShard]) -> list[FileEntry]:
    return sorted((entry for each in closed for entry in each.derived), key=_path)


def _path(entry: FileEntry) -> str:
    return entry.path


def _move(layout: Layout, recipe: Recipe, names: list[str]) -> None:
    for table in tables_of(recipe.output.formats):
        (layout.root / table.name).mkdir(exist_ok=True)
        for name in names:
            with suppress(FileNotFoundError):  # it was moved before a stop, or stood there before the set grew
                layout.staged(table.name, name).replace(layout.shard(table.name, name))
            if not layout.shard(table.name, name).exists():
                raise _lost(layout, name, layout.shard(table.name, name))
        sync_directory(layout.root / table.name)


def _lost(layout: Layout, shard: str, path: Path) -> RubgenError:
    layout.closed(shard).unlink(missing_ok=True)
    return RubgenError(f"{path}: lost or damaged: give the same command again, it makes this shard anew")


def _in_order(layout: Layout, spans: list[tuple[int, int, str]], runs: int, types: pa.Schema) -> Iterator[pa.Table]:
    """Yield the rows of all runs in order. The rows of a shard are read once."""
    remaining, loaded = list(reversed(spans)), list[tuple[IntArray, pa.Table]]()
    for start in range(0, runs, ROWS_PER_GROUP):
        end = start + ROWS_PER_GROUP
        while remaining and remaining[-1][0] < end:
            loaded.append(_rows(layout, remaining.pop()[2], types))
        numbers, pieces = [], []
        for indexes, table in loaded:
            first, last = np.searchsorted(indexes, [start, end])
            numbers.append(indexes[first:last])
            pieces.append(table.slice(first, last - first))
        loaded = [each for each in loaded if each[0][-1] >= end]
        order = np.argsort(np.concatenate(numbers))
        yield pa.concat_tables(pieces).combine_chunks().take(pa.array(order))


def _rows(layout: Layout, shard: str, types: pa.Schema) -> tuple[IntArray, pa.Table]:
    path = layout.staged(RUNS.name, shard)
    try:
        table = read_table(path, types.names).cast(types)
    except (UserError, pa.ArrowException):
        raise _lost(layout, shard, path) from None
    return np.array([index_of(name) for name in table["run_id"].to_pylist()]), table
