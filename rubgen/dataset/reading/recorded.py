"""Read recorded channels and pulses of runs, from the Parquet files of a set or from files of single runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pyarrow as pa

from rubgen.dataset.layout import Layout
from rubgen.dataset.manifest import Manifest
from rubgen.dataset.rows import RunRows
from rubgen.errors import UserError
from rubgen.formats import run_formats
from rubgen.io.parquet.features import is_list
from rubgen.measurement.channel import Float32Array
from rubgen.scenario.run_id import run_id_of

PULSES = "once_per_rev_s"


def parquet_signals(
    signals: RunRows, truth: RunRows, run_ids: Sequence[str], names: Sequence[str]
) -> Iterator[tuple[str, pa.Table]]:
    """Yield the name of each run and a table of its columns `names`, read from two tables of a set.

    - signals, truth: the tables `signals` and `truth`. A table with none of the columns is not opened.
    - run_ids: names of the runs, in the order of the results.

    Raises UserError where a run has no row or a file is damaged, as `RunRows.each` does.
    """
    seen = [name for name in names if name in signals.types.names]
    hidden = [name for name in names if name not in seen]
    if not hidden or not seen:
        yield from truth.each(run_ids, hidden) if hidden else signals.each(run_ids, seen)
        return
    for (run_id, left), (_, right) in zip(signals.each(run_ids, seen), truth.each(run_ids, hidden), strict=True):
        columns = _columns(left) | _columns(right)
        yield run_id, pa.table({name: columns[name] for name in names})


def exported_signals(
    layout: Layout, manifest: Manifest, run_ids: Sequence[str], names: Sequence[str]
) -> Iterator[tuple[str, pa.Table]]:
    """Yield the name of each run and a table of its channels `names` and pulses, read from files of single runs (MCAP).

    Raises UserError where a run has no such file, and where the file cannot be read or contains another run.
    """
    readers = [(each.signals, each.name) for each in run_formats() if each.signals]
    listed = {name for _, folder in readers for name in manifest.listed(folder)}
    for run_id in run_ids:
        paths = [(read, layout.export(name, run_id)) for read, name in readers]
        found = [each for each in paths if each[1].relative_to(layout.root).as_posix() in listed]
        if not found:
            raise UserError(f"{layout.root}: has no files with signals; generate it with formats parquet or mcap")
        read, path = found[0]
        run = read(path, names)
        if run_id != run_id_of(run.number):
            raise UserError(f"{path}: holds {run_id_of(run.number)}; run rubgen verify")
        yield run_id, pa.table({name: [run.channels[name]] for name in names} | {PULSES: [run.once_per_rev]})


def is_signal(field: Any) -> bool:
    """Return whether the column of this Arrow field contains recorded channels: lists of float32."""
    return is_list(field.type) and bool(field.type.value_type == pa.float32())


def row_signals(table: pa.Table, row: int) -> dict[str, Float32Array]:
    """Return the recorded channels in row number `row` of a data table, by name. The arrays are read-only."""
    names = [field.name for field in table.schema if is_signal(field)]
    return {name: np.asarray(table[name][row].values, dtype=np.float32) for name in names}


def _columns(table: pa.Table) -> dict[str, pa.ChunkedArray]:
    return dict(zip(table.column_names, table.columns, strict=True))
