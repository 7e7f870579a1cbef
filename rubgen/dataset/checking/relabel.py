"""Make the labels of a data set again from its compact records, and compare them with the stored labels."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any

import pyarrow as pa

from rubgen.dataset.layout import Layout
from rubgen.dataset.manifest import read_manifest
from rubgen.dataset.rows import RunTable, asked_bytes
from rubgen.dataset.shards import shards_of
from rubgen.errors import UserError
from rubgen.io.parquet.compact_records import SCHEMA, read_record
from rubgen.io.parquet.read import row_groups
from rubgen.io.parquet.words import with_words
from rubgen.labels.registry import TAP_ENDINGS
from rubgen.labels.to_json import remade_labels

RELATIVE, ABSOLUTE = 1e-9, 1e-12
"""Numbers within this of each other are equal: another machine's BLAS rounds differently."""


@dataclass(frozen=True)
class Difference:
    """A label of a run that differs: its value in `runs.parquet` (`stands`), and the newly computed value (`again`)."""

    run_id: str
    label: str
    stands: object
    again: object


@dataclass(frozen=True, kw_only=True)
class Relabelled:
    """The result of `relabel`: the numbers of runs and labels that were computed again, and the labels that differ."""

    runs: int
    labels: int
    differences: tuple[Difference, ...]


def relabel(directory: Path) -> Relabelled:
    """Compute the labels of every good run again from its compact record, and compare them with `runs.parquet`.

    Numbers are equal within rounding (`equal`). Labels of orders are left out: they need the signals at every step.
    Nothing is simulated and no file is changed. Raises UserError where `directory` holds no finished data set or a set
    without `sections/`, and where a file is damaged or `sections/` has other runs than `runs.parquet`.
    """
    layout = Layout(directory)
    manifest = read_manifest(layout)
    recorded = manifest.identity.recorded(str(layout.manifest))
    if not manifest.listed("sections"):
        raise UserError(f"{layout.root}: no sections/ to make labels from; generate the set again with this rubgen")
    runs = labels = 0
    found: list[Difference] = []
    table, asked = RunTable(layout.runs), asked_bytes(recorded)
    for shard in shards_of(recorded):
        path = layout.shard("sections", shard.name)
        for row, section in zip_longest(_good_rows(table.rows(shard.indexes)), _remade(path, asked)):
            run_id, again = section or ("", {})
            if row is None or row["run_id"] != run_id:
                name = row["run_id"] if row else run_id
                raise UserError(f"{layout.root}: sections/ and runs.parquet differ at {name}; check it: rubgen verify")
            runs, labels = runs + 1, labels + len(again)
            found += [
                Difference(run_id, name, row.get(name), value)
                for name, value in again.items()
                if name not in row or not equal(row[name], value)
            ]
    return Relabelled(runs=runs, labels=labels, differences=tuple(found))


def _good_rows(table: pa.Table) -> Iterator[dict[str, Any]]:
    """Yield the runs that ended well, in order, without the columns of orders."""
    names = [name for name in table.schema.names if not name.endswith(TAP_ENDINGS)]
    yield from (row for row in with_words(table.select(names)).to_pylist() if row["status"] == "ok")


def _remade(path: Path, asked: float) -> Iterator[tuple[str, dict[str, object]]]:
    """Yield name and labels of each run with a compact record in the file at `path`."""
    for table in row_groups(path, asked):
        if not table.schema.equals(SCHEMA):
            raise UserError(f"{path}: its columns are not those of this rubgen; generate the set again")
        for row, run_id in enumerate(table["run_id"].to_pylist()):
            yield run_id, remade_labels(read_record(table, row, path))


def equal(one: object, other: object) -> bool:
    """Return whether two labels are equal. Floats may differ by RELATIVE or ABSOLUTE; lists are compared by element."""
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(equal, one, other))
    if isinstance(one, float) and isinstance(other, float):
        return math.isclose(one, other, rel_tol=RELATIVE, abs_tol=ABSOLUTE)
    return one == other
