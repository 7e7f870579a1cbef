"""Find the rows of single runs in Parquet files with many runs."""

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property, lru_cache, partial
from itertools import accumulate, groupby
from pathlib import Path
from typing import Any, NamedTuple

import pyarrow as pa

from rubgen.dataset.layout import RUNS_PER_ROW_GROUP
from rubgen.errors import UserError
from rubgen.io.parquet.read import ParquetSource, damage_named
from rubgen.scenario import Recipe
from rubgen.scenario.costs import stored_bytes
from rubgen.scenario.scenario import Chosen
from rubgen.scenario.tables.balance import NO_CANDIDATE

GROUPS_IN_MEMORY = 8
"""Of `runs.parquet`: shards of several splits lie beside each other in the order of runs."""
FILES_OPEN = 16
"""Files of a table that stay open: to open one takes longer than to read a channel."""


def asked_bytes(recipe: Recipe) -> float:
    """Estimate the largest unpacked size in bytes of a row group in the data set of this recipe.

    It is the size of RUNS_PER_ROW_GROUP runs with their channels and states, at the extreme values of `[vary]`. Readers
    allow this size beyond their general bound.
    """
    return RUNS_PER_ROW_GROUP * max(map(stored_bytes, recipe.corners()))


def remember(recipe: Recipe, index: int, row: Mapping[str, Any]) -> None:
    """Make `recipe` use the recorded candidates of a run's machine and balance, so that they are not checked again.

    - recipe: the recipe of the set, not of a merged set.
    - index: number of the run.
    - row: its row in `runs.parquet`, with the words of classes.
    """
    if recipe.machines and row["machine_candidate"] < recipe.machines.tries:
        recipe.remember(row["machine_number"], row["machine_candidate"])
    if not recipe.balance or not len(row["balance_seen"]):  # it was never screened
        return
    chosen = Chosen(
        cell=row["balance_cell"],
        tries=row["balance_tries"],
        seen=tuple(row["balance_seen"]),
        problem=row["reason"] if row["status"] == "refused" and row["reason"].startswith(NO_CANDIDATE) else "",
    )
    partner = recipe.twin_of(index)
    recipe.remember_choice(index if partner is None else partner, chosen)


class Place(NamedTuple):
    """The position of a run's row: file, number of the row group, number of the row in the group."""

    file: Path
    group: int
    row: int


class RunRows:
    """Access to single runs in Parquet files with one row for each run.

    The last FILES_OPEN files that were read stay open.
    """

    def __init__(self, files: Sequence[Path], types: pa.Schema, asked_bytes: float) -> None:
        """Take the files, their schema `types`, and the unpacked size of a row group (function `asked_bytes`)."""
        self.files, self.types = files, types
        self._open = lru_cache(FILES_OPEN)(partial(ParquetSource, asked_bytes=asked_bytes))

    @cached_property
    def places(self) -> dict[str, Place]:
        """The position of every run's row, by the run's name. Raises UserError where a file is missing or damaged."""
        places: dict[str, Place] = {}
        for path in self.files:
            file = self._open(path)
            for group in range(file.num_row_groups):
                names = file.read_row_group(group, columns=["run_id"])["run_id"].to_pylist()
                places |= {name: Place(path, group, row) for row, name in enumerate(names)}
        return places

    def each(self, run_ids: Iterable[str], columns: Sequence[str]) -> Iterator[tuple[str, pa.Table]]:
        """Yield the name of each run in `run_ids`, in the same order, and its row: a table of one row.

        `columns` are the names of the columns to read. A name that is not in the schema raises KeyError. A row group is
        read once for successive runs in it.

        Raises UserError, which names the run: before the first row, where any run has no row; at its row, where a value
        is null, a column is missing or a page is damaged.
        """
        run_ids = list(run_ids)
        lost = [run_id for run_id in run_ids if run_id not in self.places]
        if lost:
            if not self.files:
                raise UserError(f"{lost[0]}: the set has no such files; generate it with the format parquet")
            raise UserError(f"{lost[0]}: has no row in {self.files[0].parent}; generate the set again")
        types = pa.schema([self.types.field(name) for name in columns])
        for path, names in groupby(run_ids, key=lambda run_id: self.places[run_id].file):
            file = self._open(path)
            for group, members in groupby(names, key=lambda run_id: self.places[run_id].group):
                runs = list(members)
                try:
                    table = file.read_row_group(group, columns=columns)
                    with damage_named(path):
                        table = table.cast(types)
                except UserError as error:
                    raise UserError(f"{', '.join(runs)}: {error}") from None
                for run_id in runs:
                    yield run_id, _whole(table.slice(self.places[run_id].row, 1), run_id, path)


def _whole(row: pa.Table, run_id: str, path: Path) -> pa.Table:
    for name in row.column_names:
        if row[name].null_count:
            raise UserError(f"{run_id}: {path}: has no {name} of this run; generate the set again")
    return row


class RunTable:
    """Rows of `runs.parquet` by the number of the run. A few row groups at a time are in memory."""

    def __init__(self, path: Path) -> None:
        """Open the file. Raises UserError where it is missing or damaged."""
        self._file = ParquetSource(path)
        sizes = [self._file.rows_of(group) for group in range(self._file.num_row_groups)]
        self._starts = list(accumulate(sizes, initial=0))
        self._group = lru_cache(GROUPS_IN_MEMORY)(self._file.read_row_group)

    def rows(self, indexes: Sequence[int]) -> pa.Table:
        """Return the rows of the runs with these numbers, which must ascend. Classes are numbers, as in the file.

        Raises UserError where a row cannot be read.
        """
        if indexes and indexes[-1] >= self._starts[-1]:
            raise UserError(f"{self._file.path}: has no run number {indexes[-1]}")
        pieces = []
        for group, members in groupby(indexes, key=lambda index: bisect_right(self._starts, index) - 1):
            places = [index - self._starts[group] for index in members]
            pieces.append(self._group(group).take(places))
        return pa.concat_tables(pieces or [self._file.schema_arrow.empty_table()])
