"""Parquet files of the real writer, with columns and values that no set of rubgen has."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

NUMBERS = (float("nan"), float("inf"), -float("inf"), 0.0, -1.0, 1e300, 1e-300, 1e9)
WORDS = ("", "x", "ok", "run-000000", "run-1", "run-999999999999", "../x", "chaotic", "é\0", "a" * 3000)


def hostile_parquet(good: Path, path: Path, generator: np.random.Generator) -> None:
    """Write the table of `good` with one to three changes to `path`."""
    table = _table(good)
    for _ in range(generator.integers(1, 4)):
        table = _CHANGES[generator.integers(len(_CHANGES))](table, generator)
    pq.write_table(
        table,
        path,
        compression=str(generator.choice(["zstd", "none", "snappy", "gzip"])),
        row_group_size=int(generator.choice([1, 8, 10**6])),
        write_page_checksum=bool(generator.random() < 0.5),
        use_dictionary=bool(generator.random() < 0.5),
        store_schema=bool(generator.random() < 0.5),
    )


@cache
def _table(path: Path) -> pa.Table:
    return pq.read_table(path)


def _values(table: pa.Table, generator: np.random.Generator) -> pa.Table:
    """One value of a column, of its own type."""
    place = int(generator.integers(table.num_columns))
    field = table.schema.field(place)
    values = table.column(place).to_pylist()
    if not values:
        return table
    row = int(generator.integers(len(values)))
    values[row] = _wrong(field.type, values[row], generator)
    try:
        return table.set_column(place, field, pa.array(values, field.type))
    except (pa.ArrowException, OverflowError, TypeError, ValueError):
        return table


def _wrong(kind: Any, value: Any, generator: np.random.Generator) -> Any:
    if generator.random() < 0.15:
        return None
    if pa.types.is_list(kind):
        each = _wrong(kind.value_type, 0, generator)
        values = list(value or [])
        return [[], [each], [*values, each], values[:-1], [each] * max(len(values), 1), values * 2][
            generator.integers(6)
        ]
    if pa.types.is_string(kind):
        return WORDS[generator.integers(len(WORDS))]
    if pa.types.is_boolean(kind):
        return not value
    number = NUMBERS[generator.integers(len(NUMBERS))]
    return number if pa.types.is_floating(kind) else int(np.clip(np.nan_to_num(number), -1, 127))


def _kind(table: pa.Table, generator: np.random.Generator) -> pa.Table:
    """A column of another type."""
    place = int(generator.integers(table.num_columns))
    name, rows = table.schema.names[place], table.num_rows
    columns = [
        pa.nulls(rows), pa.array([b"x"] * rows), pa.array([1] * rows), pa.array(["1"] * rows), pa.array([0.5] * rows),
        pa.array([{"a": 1}] * rows), pa.array([[1.0]] * rows), pa.array([[[1.0]]] * rows), pa.array([True] * rows),
        pa.array([0] * rows, pa.timestamp("ns")), pa.array(["x"] * rows).dictionary_encode(),
        pa.array([None] * rows, pa.string()), pa.array([2**63] * rows, pa.uint64()),
        pa.array([None] * rows, pa.float64()),
    ]  # fmt: skip
    return table.set_column(place, name, columns[generator.integers(len(columns))])


def _shape(table: pa.Table, generator: np.random.Generator) -> pa.Table:
    """Columns and rows: missing, twice, more, in another order."""
    place, names = int(generator.integers(table.num_columns)), table.schema.names
    case = generator.integers(7)
    if case == 0:
        return table.remove_column(place) if table.num_columns > 1 else table
    if case == 1:
        return table.append_column(str(generator.choice(["extra", "", "é", names[place]])), table.column(place))
    if case == 2:
        return table.rename_columns([f"{name}x" if i == place else name for i, name in enumerate(names)])
    if case == 3:
        return table.slice(0, int(generator.integers(table.num_rows + 1)))
    if case == 4:
        return pa.concat_tables([table, table]) if table.num_rows < 1000 else table
    if case == 5:
        return table.take(pa.array(generator.permutation(table.num_rows)))
    return (
        table.select([names[i] for i in generator.permutation(len(names))]) if len(set(names)) == len(names) else table
    )


_CHANGES = (_values, _values, _values, _kind, _kind, _shape)
