"""Join the staged files of finished runs into the files of the data set, with few runs in memory at a time."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TypeVar

import pyarrow as pa

from rubgen.dataset.layout import RUNS_PER_ROW_GROUP, RUNS_PER_SHARD, Layout
from rubgen.dataset.rows import asked_bytes
from rubgen.dataset.tables import RUNS, tables_of
from rubgen.errors import RubgenError, UserError
from rubgen.io.files import sync_directory
from rubgen.io.parquet.read import read_table
from rubgen.io.parquet.write import write_table
from rubgen.scenario import Recipe

T = TypeVar("T")
ROWS_PER_TABLE_GROUP = 4096


def assemble(recipe: Recipe, layout: Layout) -> Counter[str]:
    """Write `runs.parquet`, data files and sections of a data set from its staged runs.

    All runs of the recipe must be staged. Returns the number of runs by status. Where a staged file is damaged, its run
    is unstaged and RubgenError is raised: the same command makes that run anew.
    """
    staged = [layout.staged(f"run-{index:06d}") for index in range(recipe.runs)]
    asked = asked_bytes(recipe)
    status = _write_runs(staged, layout, RUNS.schema(recipe), asked)
    valid = [path for path, code in zip(staged, status, strict=True) if code == "ok"]
    for table in tables_of(recipe.output.formats):
        rows = [layout.staged_row(table.name, path.stem) for path in valid]
        _write_shards(rows, valid, partial(layout.shard, table.name), table.schema(recipe), asked)
        sync_directory(layout.root / table.name)
    sync_directory(layout.root)
    return Counter(status)


def _write_runs(staged: Sequence[Path], layout: Layout, types: pa.Schema, asked: float) -> list[str]:
    """Write `runs.parquet`. Return the status of each run."""
    status: list[str] = []

    def tables() -> Iterator[pa.Table]:
        for paths in _batches(staged, ROWS_PER_TABLE_GROUP):
            table = pa.concat_tables([_read(path, path, types.names, asked) for path in paths]).combine_chunks()
            status.extend(table["status"].to_pylist())
            yield table.cast(types)

    write_table(tables(), types, layout.runs)
    return status


def _write_shards(
    staged: Sequence[Path],
    rows: Sequence[Path],
    name_of: Callable[[int, int], Path],
    types: pa.Schema,
    asked: float,
) -> None:
    """Write files with many rows from staged tables of one row; `rows` are the staged runs that they belong to."""
    shards = list(_batches(list(zip(staged, rows, strict=True)), RUNS_PER_SHARD)) or [[]]
    for number, shard in enumerate(shards):
        groups = (_joined(group, types, asked) for group in _batches(shard, RUNS_PER_ROW_GROUP))
        write_table(groups, types, name_of(number, len(shards)))


def _joined(group: Sequence[tuple[Path, Path]], types: pa.Schema, asked: float) -> pa.Table:
    return pa.concat_tables([_read(path, row, types.names, asked) for path, row in group]).combine_chunks()


def _read(path: Path, row: Path, names: list[str], asked: float) -> pa.Table:
    """Read a staged table. Where it is damaged its run no longer counts as finished, and the next call makes it."""
    try:
        return read_table(path, names, asked)
    except UserError as error:
        row.unlink(missing_ok=True)
        raise RubgenError(f"{error}: give the same command again, it makes this run anew") from None


def _batches(items: Sequence[T], size: int) -> Iterator[Sequence[T]]:
    for start in range(0, len(items), size):
        yield items[start : start + size]
