"""Copy one shard of a data set into another set, with new names of its runs, and close it there."""

import dataclasses
import hashlib
from collections import Counter
from pathlib import Path

import pyarrow as pa

from rubgen.brief import in_shell
from rubgen.dataset.files import sha256_of
from rubgen.dataset.layout import Layout
from rubgen.dataset.making.close import write_closed
from rubgen.dataset.making.make_runs import simulated
from rubgen.dataset.manifest import FileEntry, read_derived
from rubgen.dataset.merging.sources import SourceSet
from rubgen.dataset.reading.replaying import replay_of_mcap
from rubgen.dataset.rows import RunTable, asked_bytes
from rubgen.dataset.shards import Shard
from rubgen.dataset.tables import RUNS, tables_of
from rubgen.errors import UserError
from rubgen.formats import run_formats
from rubgen.formats.format import Format
from rubgen.io.files import write_durably
from rubgen.io.mcap.rename import copy_with
from rubgen.io.parquet.read import row_groups
from rubgen.io.parquet.write import merged_from, write_table
from rubgen.scenario.merged import MergedRecipe
from rubgen.scenario.run_id import index_of, run_id_of

BLOCK_BYTES = 1 << 20
NAMES = ("run_id", "twin_of")
"""Columns that name a run of the set."""


def copy_shard(layout: Layout, recipe: MergedRecipe, source: SourceSet, own: Shard, shard: Shard) -> None:
    """Write the files of `shard` into the unfinished set of `layout`, then the record that closes the shard.

    - layout: paths of the merged set.
    - recipe: its recipe.
    - source: the source set of the shard.
    - own: the shard in the source set. Its runs have the same order.
    - shard: the shard in the merged set.

    Raises UserError where a file of the source is damaged.
    """
    rows = RunTable(source.layout.runs).rows(own.indexes).cast(RUNS.schema(source.recipe))
    types = RUNS.schema(recipe)
    write_table([_with_origin(_renamed(rows, source), recipe, types)], types, layout.staged(RUNS.name, shard.name))
    copying = _Copying(layout, recipe, source)
    for table in tables_of(recipe.output.formats):
        before, after = source.layout.shard(table.name, own.name), layout.staged(table.name, shard.name)
        if source.first:
            copying.check(before)
            groups = row_groups(before, asked_bytes(source.recipe))
            types = table.schema(recipe)
            write_table((_renamed(group, source).cast(types) for group in groups), types, after)
        else:
            copying.copy(before, after)
    status = rows["status"].to_pylist()
    good = [index for index, code in zip(own.indexes, status, strict=True) if code == "ok"]
    for each in run_formats(recipe.output.formats):
        for index in good:
            copying.copy_run(each, index)
    names = [run_id_of(index + source.first) for index in good]
    write_closed(layout, recipe, shard, dict(sorted(Counter(status).items())), names)


def _renamed(rows: pa.Table, source: SourceSet) -> pa.Table:
    """Return the rows with the names that runs have in the merged set."""
    for name in NAMES if source.first else ():
        if name in rows.column_names:
            ids = [value and run_id_of(index_of(value) + source.first) for value in rows[name].to_pylist()]
            place = rows.column_names.index(name)
            rows = rows.set_column(place, rows.schema.field(place), pa.array(ids, pa.string()))
    return rows


def _with_origin(rows: pa.Table, recipe: MergedRecipe, types: pa.Schema) -> pa.Table:
    """Return renamed rows of `runs` with the column `merged_from`."""
    numbers = map(index_of, rows["run_id"].to_pylist())
    origins = [merged_from(each.source, number - each.first) for number in numbers for each in [recipe.origin(number)]]
    columns = {name: pa.array(origins) if name == "merged_from" else rows[name] for name in types.names}
    return pa.table(columns, types).combine_chunks()


class _Copying:
    """Copies files of a set whose content is the listed one."""

    def __init__(self, layout: Layout, recipe: MergedRecipe, source: SourceSet) -> None:
        self._layout, self._recipe, self._source = layout, recipe, source
        self._listed = {entry.path: entry for entry in source.manifest.files}
        self._listed |= read_derived(source.layout) if source.manifest.derived else {}

    def check(self, path: Path) -> None:
        """Raise UserError where the content of a file of the source is not the listed one."""
        if sha256_of(path) != self._entry(path).sha256:
            raise self._damaged(path)

    def copy(self, path: Path, to: Path) -> None:
        """Copy a file of the source, byte for byte. Raises UserError where its content is not the listed one."""
        sha256, found = self._entry(path).sha256, hashlib.sha256()

        def write(part: Path) -> None:
            with path.open("rb") as stream, part.open("wb") as out:
                while block := stream.read(BLOCK_BYTES):
                    found.update(block)
                    out.write(block)
            if found.hexdigest() != sha256:
                raise self._damaged(path)

        write_durably(to, write)

    def copy_run(self, kind: Format, index: int) -> None:
        """Write the file of run number `index` of the source, in a format with one file for each run.

        Raises UserError where the content of the source's file is not the listed one.
        """
        number = index + self._source.first
        before = self._source.layout.export(kind.name, run_id_of(index))
        after = self._layout.export(kind.name, run_id_of(number))
        after.parent.mkdir(parents=True, exist_ok=True)
        if not self._source.first:
            self.copy(before, after)
        elif kind.remake is None:
            self.check(before)
            copy_with(before, after, {"merged": dataclasses.asdict(self._recipe.origin(number))})
        elif "mcap" in self._recipe.output.formats:
            kind.remake(replay_of_mcap(self._layout.export("mcap", run_id_of(number))).replay, after)
        else:
            kind.write(simulated(self._recipe, number), after)

    def _entry(self, path: Path) -> FileEntry:
        name = path.relative_to(self._source.layout.root).as_posix()
        if name not in self._listed:
            raise UserError(f"{self._source.layout.manifest}: lists no {name}; check the set: rubgen verify")
        return self._listed[name]

    def _damaged(self, path: Path) -> UserError:
        remedy = f"rubgen repair {in_shell(self._source.layout.root)}"
        return UserError(f"{path}: damaged, its sha256 is not the one in the manifest; {remedy}")
