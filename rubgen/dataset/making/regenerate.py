"""Make one run of a data set again from its manifest, and say where it differs from what is stored."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.compute as pc

from rubgen.dataset.layout import Layout
from rubgen.dataset.making.remake import other_versions
from rubgen.dataset.manifest import read_manifest
from rubgen.dataset.rows import RunTable, asked_bytes
from rubgen.dataset.shards import shards_of
from rubgen.dataset.tables import RUNS, tables_of
from rubgen.errors import UserError
from rubgen.io.parquet.read import row_groups
from rubgen.io.parquet.words import with_words
from rubgen.labels import Motion
from rubgen.labels.registry import TAP_ENDINGS
from rubgen.scenario import Recipe
from rubgen.scenario.run_id import index_of, run_id_of

if TYPE_CHECKING:
    from rubgen.pipeline import Run

PERIODIC_TOLERANCE = 1e-6
"""Largest relative difference of a label of a period-1 run between versions that counts as none."""
ORDER_TOLERANCE = 0.2
"""The same for amplitudes at orders of any other run: of a chaotic motion they are means over the record."""


@dataclass(frozen=True, kw_only=True)
class Regenerated:
    """A run that was made again, and its differences from the stored one."""

    run: Run
    versions: dict[str, tuple[str, str]]
    """Packages with other versions: by name, the version of the set and the installed one."""
    different: dict[str, list[str]]
    """Columns whose bits differ, by table. Empty where the run is equal to the bit."""
    moved: list[str]
    """Of these the labels that differ by more than other versions explain."""


def regenerate(directory: Path | str, run_id: str) -> Regenerated:
    """Make the run called `run_id` of a data set again from its manifest, and compare it with the stored one.

    With the versions that made the set, on the same kind of processor, every bit is equal. With others a period-1 run
    has the same labels within PERIODIC_TOLERANCE; any other run the same class of motion, and amplitudes at orders
    within ORDER_TOLERANCE. Raises UserError where there is no such set or run.
    """
    from rubgen.dataset.making.make_runs import simulated

    layout = Layout(directory)
    manifest = read_manifest(layout)
    recipe = manifest.identity.recorded(str(layout.manifest))
    try:
        index = index_of(run_id)
    except ValueError:
        index = -1
    if not 0 <= index < manifest.runs:
        raise UserError(f"{layout.root}: no run {run_id!r}; give {run_id_of(0)} to {run_id_of(manifest.runs - 1)}")
    run = simulated(recipe, index)
    stored = _stored(layout, recipe, index)
    made = {RUNS.name: RUNS.row(run, recipe.split_of(index))}
    if run.labels is not None:
        rows = {each.name: each.row(run, recipe.split_of(index)) for each in tables_of(recipe.output.formats)}
        made |= {name: table for name, table in rows.items() if table.num_rows}
    different = {name: found for name in made.keys() | stored.keys() if (found := _different(made, stored, name))}
    moved = _moved(with_words(made[RUNS.name]), with_words(stored[RUNS.name]))
    return Regenerated(run=run, versions=other_versions(manifest), different=different, moved=moved)


def _stored(layout: Layout, recipe: Recipe, index: int) -> dict[str, pa.Table]:
    """Read the row of a run in every table where it has one."""
    run_id = run_id_of(index)
    rows = {RUNS.name: RunTable(layout.runs).rows([index])}
    (shard,) = [each for each in shards_of(recipe) if index in each.indexes]
    for table in tables_of(recipe.output.formats):
        for group in row_groups(layout.shard(table.name, shard.name), asked_bytes(recipe)):
            mine = group.filter(pc.equal(group["run_id"], run_id))
            if mine.num_rows:
                rows[table.name] = mine
    return rows


def _different(made: dict[str, pa.Table], stored: dict[str, pa.Table], name: str) -> list[str]:
    one, other = made.get(name), stored.get(name)
    if one is None or other is None or one.num_rows != other.num_rows:
        return ["number of rows"]
    columns = [*one.column_names, *(column for column in other.column_names if column not in one.column_names)]
    return [column for column in columns if not _same(one, other, column)]


def _same(one: pa.Table, other: pa.Table, column: str) -> bool:
    if column not in one.column_names or column not in other.column_names:
        return False
    first, second = (bytes_of(table[column]) for table in (one, other))
    return first == second


def bytes_of(column: pa.ChunkedArray) -> object:
    """Return the values of a column so that equal ones have equal bits, NaN too."""
    return [_bits(value) for value in column.to_pylist()]


def _bits(value: Any) -> object:
    if isinstance(value, list):
        return [_bits(each) for each in value]
    return value.hex() if isinstance(value, float) else value


def _moved(made: pa.Table, stored: pa.Table) -> list[str]:
    """Return the labels that differ by more than the tolerance for the motion of the run."""
    (new,), (old,) = made.to_pylist(), stored.to_pylist()
    if new["status"] != old["status"] or new["motion"] != old["motion"] or new["rub"] != old["rub"]:
        return [name for name in ("status", "motion", "rub") if new[name] != old[name]]
    periodic = new["motion"] == Motion.PERIOD_1.value
    names = [name for name in new if periodic or name.endswith(TAP_ENDINGS)]
    tolerance = PERIODIC_TOLERANCE if periodic else ORDER_TOLERANCE
    return [name for name in names if name in old and not _close(new[name], old[name], tolerance)]


def _close(one: Any, other: Any, tolerance: float) -> bool:
    """Return whether two values are equal within the tolerance; in a list, relative to its largest value."""
    if isinstance(one, list) and isinstance(other, list):
        numbers = [abs(each) for each in (*one, *other) if isinstance(each, float)]
        scale = max(numbers, default=0.0)
        pairs = zip(one, other, strict=False)
        return len(one) == len(other) and all(
            math.isclose(a, b, rel_tol=tolerance, abs_tol=tolerance * scale) if isinstance(a, float) else a == b
            for a, b in pairs
        )
    if isinstance(one, float) and isinstance(other, float):
        return math.isclose(one, other, rel_tol=tolerance) or (math.isnan(one) and math.isnan(other))
    return bool(one == other)
