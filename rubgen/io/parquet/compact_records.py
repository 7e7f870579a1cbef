"""Compact records of runs as Parquet: the part of the true response from which its labels can be made again.

One row a run. Arrays are stored as flat lists, row after row.
"""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from rubgen.errors import UserError
from rubgen.labels.compact_record import SCALARS, TOUCHES, CompactRecord, compact_record, named_scalars
from rubgen.solver.response import Response

RECORD_COLUMNS: dict[str, tuple[pa.DataType, str]] = {
    "scalars": (pa.float64(), ", ".join(SCALARS)),
    "section": (
        pa.float32(),
        "once a turn: tips, x, y, v_x, v_y of the disk centre, casing modes and their velocities",
    ),
    "fractions": (pa.float32(), "the same after each Nth of the last turn, N lobes"),
    "growth": (pa.float32(), "ln of the companion's growth in each of its turns"),
    "turn_impulse": (pa.float64(), "normal impulse of each turn, N s"),
    "contact_steps": (pa.int32(), "steps with contact in each turn"),
    "orbit": (pa.float32(), "last 100 turns, or all: means of X, Y, X^2 + Y^2, V_X^2 + V_Y^2, X V_Y - Y V_X"),
    "rotation": (pa.float64(), "start, end (rad/s), seconds, swing (rad/s), period (s) of a changing speed"),
    "turn_steps": (pa.int32(), "first step of each turn of a changing speed"),
    "blade": (pa.int16(), "blade of each touch"),
    "start_step": (pa.int32(), "first step of each touch, from the record's start"),
    "steps": (pa.int32(), "its number of steps"),
    "angle": (pa.float32(), "its polar angle on the casing, rad"),
    "impulse": (pa.float32(), "its normal impulse, N s"),
    "friction_loss": (pa.float32(), "its work of friction, J"),
    "normal_loss": (pa.float32(), "its work lost along the normal, J"),
}
"""Element type and meaning of each list. The number of turns in `scalars` divides a list into rows."""
SCHEMA = pa.schema(
    [pa.field("run_id", pa.string())]
    + [
        pa.field(name, pa.list_(kind), metadata={"meaning": meaning})
        for name, (kind, meaning) in RECORD_COLUMNS.items()
    ]
)

TOUCH_COLUMNS = ("scalars", "turn_steps", *TOUCHES)
"""The columns that tell of the touches."""
COUNTS = ("steps_per_turn", "settle_turns", "record_turns", "n_blades", "n_casing")
MOST_COUNTED = 2**31
"""No number of COUNTS is as large."""


def record_table(run_id: str, response: Response) -> pa.Table:
    """Make the table row with the compact record of run `run_id`, which must have the status OK."""
    record = compact_record(response)
    columns = {name: pa.array([record[name].ravel()], pa.list_(kind)) for name, (kind, _) in RECORD_COLUMNS.items()}
    return pa.table({"run_id": pa.array([run_id])} | columns, schema=SCHEMA)


class _MisfitError(Exception):
    """Lists of a row that do not fit each other, or a number that cannot be there."""


def read_record(table: pa.Table, row: int, path: Path) -> CompactRecord:
    """Read the compact record in row number `row` of `table`. Returns its arrays by name; they are read-only.

    `path` is the file of the table, for messages. Raises UserError where the lengths of its lists contradict each other
    or a number is not valid.
    """
    with _misfits_named(table, row, path):
        record = {name: _listed(table, name, row) for name in RECORD_COLUMNS}
        scalars = _scalars(record["scalars"])
        width = 3 * scalars["n_blades"] + 4 + 2 * scalars["n_casing"]
        for name, columns in (("section", width), ("fractions", width), ("orbit", 5)):
            if record[name].size % columns:
                raise _MisfitError(f"{name} has {record[name].size} numbers, in rows of {columns}")
            record[name] = record[name].reshape(-1, columns)
        _check_turns(record, scalars["record_turns"])
        _check_touches(record, scalars["n_blades"])
    return record


def read_touches(table: pa.Table, row: int, path: Path) -> CompactRecord:
    """Read the columns TOUCH_COLUMNS of a compact record. The rest is as in `read_record`."""
    with _misfits_named(table, row, path):
        record = {name: _listed(table, name, row) for name in TOUCH_COLUMNS}
        _check_touches(record, _scalars(record["scalars"])["n_blades"])
    return record


@contextmanager
def _misfits_named(table: pa.Table, row: int, path: Path) -> Iterator[None]:
    try:
        yield
    except _MisfitError as misfit:
        raise UserError(f"{path}: {table['run_id'][row].as_py()}: {misfit}; generate the set again") from None


def _listed(table: pa.Table, name: str, row: int) -> np.ndarray[Any, Any]:
    values = table[name][row].values
    if values is None:
        raise _MisfitError(f"{name} is null")
    return np.asarray(values)


def _scalars(values: np.ndarray[Any, Any]) -> dict[str, int]:
    """Return the counts among the scalars by name."""
    if values.size not in (len(SCALARS), len(SCALARS) + 1):
        raise _MisfitError(f"scalars has {values.size} of {len(SCALARS)} numbers")
    named = named_scalars(values.tolist())
    for name in ("speed", "dt"):
        if not math.isfinite(named[name]):
            raise _MisfitError(f"{name} is {named[name]}")
    for name in COUNTS:
        if not (0 <= named[name] <= MOST_COUNTED and named[name].is_integer()):
            raise _MisfitError(f"{name} is {named[name]}, no count")
    return {name: int(named[name]) for name in COUNTS}


def _check_turns(record: CompactRecord, turns: int) -> None:
    """Raise _MisfitError where lists of turns differ in length or hold what is no number."""
    for name in ("turn_impulse", "contact_steps", "section", "orbit"):
        if not np.isfinite(record[name]).all():
            raise _MisfitError(f"{name} is not finite")
    for name in ("section", "turn_impulse", "contact_steps"):
        if len(record[name]) != turns:
            raise _MisfitError(f"{name} has {len(record[name])} of {turns} turns")
    if record["rotation"].size not in (0, 5) or (record["rotation"].size and record["turn_steps"].size != turns + 1):
        raise _MisfitError("rotation and turn_steps do not fit the number of turns")


def _check_touches(record: CompactRecord, blades: int) -> None:
    """Raise _MisfitError where lists of touches differ in length, hold what is no number, or name no blade."""
    for name in TOUCHES:
        if not np.isfinite(record[name]).all():
            raise _MisfitError(f"{name} is not finite")
    if len({record[name].size for name in TOUCHES}) > 1:
        raise _MisfitError("lists of touches differ in length")
    if record["blade"].size and not 0 <= record["blade"].min() <= record["blade"].max() < blades:
        raise _MisfitError(f"a touch is of a blade that is none of {blades}")
