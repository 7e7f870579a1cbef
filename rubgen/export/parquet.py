"""Parquet without answers: what may be published of a test set."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pyarrow as pa

from rubgen.export.run import ExportedRun
from rubgen.io.columns import Role
from rubgen.io.parquet.write import write_table

IDS = ("run_id", "machine_id", "split")


def write_parquet(runs: Iterator[ExportedRun], path: Path) -> None:
    """Write runs, a row each: the names in IDS, recorded pulses and channels, without parameters and labels.

    `runs` must yield at least one run. `export` gives only channels that a probe can measure.
    """
    first = next(runs)
    fields = [pa.field(name, pa.string()) for name in IDS]
    fields.append(pa.field("once_per_rev_s", pa.list_(pa.float64()), metadata={"unit": "s"}))
    for channel in first.channels:
        about = {
            "unit": channel.unit,
            "role": Role.INPUT.value,
            **{name: str(fact) for name, fact in channel.facts.items()},
        }
        fields.append(pa.field(channel.name, pa.list_(pa.float32()), metadata=about))
    types = pa.schema(fields, metadata={"sample_rate_hz": repr(first.sample_rate_hz)})

    def rows() -> Iterator[pa.Table]:
        yield _row(first, types)
        yield from (_row(run, types) for run in runs)

    write_table(rows(), types, path)


def _row(run: ExportedRun, types: pa.Schema) -> pa.Table:
    values = [*(run.row[name] for name in IDS), run.pulses, *(channel.values for channel in run.channels)]
    return pa.table([pa.array([value], field.type) for value, field in zip(values, types, strict=True)], schema=types)
