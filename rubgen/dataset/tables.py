"""The tables of a data set: folder, columns, and the row of a run. Making and checking a set go over this list."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import pyarrow as pa

from rubgen.io.parquet.compact_records import SCHEMA, record_table
from rubgen.io.parquet.set_tables import (
    signals_row,
    signals_schema,
    truth_row,
    truth_schema,
    window_rows,
    windows_schema,
)
from rubgen.io.parquet.write import recipe_schema, run_table
from rubgen.scenario import Recipe

if TYPE_CHECKING:  # Run carries the solver's imports; who reads a set needs none of them
    from rubgen.pipeline import Run


@dataclass(frozen=True, kw_only=True)
class SetTable:
    """One table of a data set: its folder and columns, and a function that makes its rows of a run."""

    name: str
    """Folder of its files."""
    schema: Callable[[Recipe], pa.Schema]
    """Columns in the set of a recipe."""
    row: Callable[[Run, str], pa.Table]
    """The row of a run in the split of that name; in `windows` the rows."""
    several: bool = False
    """Whether a run has any number of rows, also none."""
    wanted: Callable[[Sequence[str]], bool] = lambda _formats: True
    """Whether a set with these formats has this table."""


RUNS = SetTable(
    name="runs",
    schema=lambda recipe: recipe_schema(recipe, signals=False),
    row=lambda run, split: run_table(run, split=split, signals=False),
)
"""Every run, failed ones too: the one file `runs.parquet`."""
SIGNALS = SetTable(
    name="signals",
    schema=signals_schema,
    row=signals_row,
    wanted=lambda formats: "parquet" in formats,
)
"""What a model may see of each run, and the answers."""
TRUTH = SetTable(
    name="truth",
    schema=truth_schema,
    row=truth_row,
    wanted=lambda formats: "parquet" in formats,
)
"""What only the simulation knows of each run beyond `runs`: touches, orders by window, channels of no sensor."""
WINDOWS = SetTable(name="windows", schema=windows_schema, row=window_rows, several=True)
"""Labels of each window of 16 turns that the signals hold: some rows a run."""
SECTIONS = SetTable(
    name="sections",
    schema=lambda _recipe: SCHEMA,
    row=lambda run, _split: record_table(run.scenario.run_id, run.response),
)
"""The compact record of each run, from which its labels can be made again."""
TABLES = (SIGNALS, TRUTH, WINDOWS, SECTIONS)
"""Tables with a row for each good run, each a folder of files of many runs."""


def files_of(table: str, split: str) -> str:
    """Return the glob pattern, within a set, of all files of the table `table` with runs of the split `split`."""
    return f"{table}/{split}-*.parquet"


def tables_of(formats: Sequence[str]) -> list[SetTable]:
    """Return the tables with a row for each good run in a set with these formats."""
    return [table for table in TABLES if table.wanted(formats)]
