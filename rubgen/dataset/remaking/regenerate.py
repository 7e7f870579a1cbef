"""Make one run of a data set again from its manifest, and say where it differs from what is stored."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.compute as pc

from rubgen.dataset.layout import Layout
from rubgen.dataset.manifest import read_manifest
from rubgen.dataset.remaking.remake import other_versions
from rubgen.dataset.rows import RunTable, asked_bytes
from rubgen.dataset.shards import shards_of
from rubgen.dataset.tables import RUNS, tables_of
from rubgen.errors import UserError
from rubgen.io.columns import DIAGNOSTICS
from rubgen.io.parquet.read import row_groups
from rubgen.io.parquet.words import with_words
from rubgen.labels import Motion
from rubgen.scenario import Recipe
from rubgen.scenario.run_id import index_of, run_id_of

if TYPE_CHECKING:
    from rubgen.pipeline import Run

PERIODIC_TOLERANCE = 1e-6
"""Largest relative difference of a label of a period-1 run between versions that counts as none."""
ORDER_TOLERANCE = 0.5
"""The same for amplitudes at orders of any other run, over the largest one of their signal. Of a chaotic motion they
are means over the record: on two kinds of processor the contact force of one chaotic run differed by 0.25."""
AMPLITUDES = ("_orders", "_order_floors", "_fractional_amplitudes", "_blade_passing")
"""Ends of the names of labels that list amplitudes of a true signal."""
PHASES = "_order_phases_rad"
SHARES = ("_even_share", "_odd_share")
EXPONENTS = ("lyapunov_per_turn", "lyapunov_per_second")


@dataclass(frozen=True, kw_only=True)
class Regenerated:
    """A run that was simulated again, and its differences from the stored run."""

    run: Run
    versions: dict[str, tuple[str, str]]
    """Packages with other versions: by name, the version of the set and the installed one."""
    different: dict[str, list[str]]
    """Columns whose bits differ, by table. Empty where the run is equal to the bit."""
    moved: list[str]
    """Of these the labels that differ by more than other versions or another processor explain."""


def regenerate(directory: Path | str, run_id: str) -> Regenerated:
    """Simulate the run called `run_id` of a data set again from its manifest, and compare it with the stored run.

    The tables are compared, not files of single runs. Differences are in the result; none is an error. With the
    versions that made the set, on the same kind of processor, every bit should be equal. Otherwise a period-1 run
    should have the same labels within PERIODIC_TOLERANCE. Any other run should have the same class of motion, and
    amplitudes at orders within ORDER_TOLERANCE. Raises UserError where the set or the run does not exist.
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
    (new,), (old,) = (with_words(each[RUNS.name]).to_pylist() for each in (made, stored))
    return Regenerated(run=run, versions=other_versions(manifest), different=different, moved=moved_labels(new, old))


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
    """Return the values of a column in a form in which values are equal only if their bits are equal, also for NaN."""
    return [_bits(value) for value in column.to_pylist()]


def _bits(value: Any) -> object:
    if isinstance(value, list):
        return [_bits(each) for each in value]
    return value.hex() if isinstance(value, float) else value


def moved_labels(new: dict[str, Any], old: dict[str, Any]) -> list[str]:
    """Return the names of a run's labels that differ by more than the tolerance for its class of motion.

    `new` and `old` are the run's rows of `runs.parquet`, with classes as words. If `status`, `motion` or `rub` differ,
    only these are named. Of a period-1 run all other labels are compared except diagnostics, of any other run only
    amplitudes. Rounding determines values that are zero in exact arithmetic, such as a phase without amplitude or the
    floor between orders. Amplitudes are therefore compared relative to the largest order of their signal, phases as
    complex amplitudes, shares by their difference, and the Lyapunov exponent within its standard error.
    """
    if new["status"] != old["status"] or new["motion"] != old["motion"] or new["rub"] != old["rub"]:
        return [name for name in ("status", "motion", "rub") if new[name] != old[name]]
    periodic = new["motion"] == Motion.PERIOD_1.value
    names = [name for name in new if name in old and name not in DIAGNOSTICS]
    if periodic:
        return [name for name in names if not _close(*_comparable(name, new, old, PERIODIC_TOLERANCE))]
    lines = [name for name in names if name.endswith(AMPLITUDES)]
    return [name for name in lines if not _close(*_comparable(name, new, old, ORDER_TOLERANCE))]


def _comparable(
    name: str, new: dict[str, Any], old: dict[str, Any], tolerance: float
) -> tuple[Any, Any, float, float | None]:
    """Return two values of a label, their relative tolerance, and the absolute one where the value alone has none."""
    one, other = new[name], old[name]
    if one is None or other is None:
        return one, other, tolerance, None
    if name in EXPONENTS:
        return one, other, 0.0, abs(old["lyapunov_error"] / old["lyapunov_per_turn"] * other)
    if name.endswith(SHARES):
        return one, other, 0.0, tolerance
    tap = next((name.removesuffix(end) for end in (*AMPLITUDES, PHASES) if name.endswith(end)), "")
    if not tap:
        return one, other, tolerance, None
    if name.endswith(PHASES):
        one, other = _amplitudes(new, tap), _amplitudes(old, tap)
    return one, other, 0.0, tolerance * max(old[f"{tap}_orders"], default=0.0)


def _amplitudes(row: dict[str, Any], tap: str) -> list[float]:
    """Return the real and imaginary parts of the complex amplitudes of a true signal at its orders."""
    waves = map(cmath.rect, row[f"{tap}_orders"], row[f"{tap}{PHASES}"])
    return [part for wave in waves for part in (wave.real, wave.imag)]


def _close(one: Any, other: Any, relative: float, absolute: float | None) -> bool:
    """Return whether two values are equal within the tolerances; in a list, relative to its largest value too."""
    if isinstance(one, list) and isinstance(other, list):
        if absolute is None:
            absolute = relative * max((abs(each) for each in (*one, *other) if isinstance(each, float)), default=0.0)
        return len(one) == len(other) and all(_close(a, b, relative, absolute) for a, b in zip(one, other, strict=True))
    if isinstance(one, float) and isinstance(other, float):
        same = math.isclose(one, other, rel_tol=relative, abs_tol=absolute or 0.0)
        return same or (math.isnan(one) and math.isnan(other))
    return bool(one == other)
