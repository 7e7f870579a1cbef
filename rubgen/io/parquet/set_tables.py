"""Tables of a data set in addition to `runs.parquet`: signals with their answers, the true motion, and windows.

`signals` has the inputs of a model and the answers. `truth` has values that only the simulation knows. So a test set
can be published without its answers.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from rubgen.io.channel_facts import channel_facts
from rubgen.io.columns import Column, Role
from rubgen.io.parquet.write import recipe_schema, run_table, table_schema
from rubgen.labels import MOTION_CLASSES, Labels, Motion
from rubgen.scenario import Recipe
from rubgen.solver.response import WINDOW_TURNS

if TYPE_CHECKING:  # Run carries the solver's imports; who reads a file needs none of them
    from rubgen.pipeline import Run

SEEN = (Role.ID, Role.TIME, Role.INPUT, Role.TARGET)
"""Roles of the columns of `signals`, in their order there."""
OF_RUN = ("run_id", "machine_id", "split")
FIRST_OF_SIGNALS = "signal_start_s"
"""The first column of a row with signals that is not in `runs`."""
WINDOW_COLUMNS = (
    Column("run_id", "text", "", "name of the run", role=Role.ID),
    Column("machine_id", "text", "", "hash of the machine before [vary]; splits never share one", role=Role.ID),
    Column("split", "text", "", "split of the data set", role=Role.ID),
    Column("window", "integer", "", "number of the window in the record of its run", role=Role.ID),
    Column("first_sample", "integer", "", "its first sample in the signals", role=Role.TIME),
    Column("samples", "integer", "", "its number of samples", role=Role.TIME),
    Column("rub", "flag", "", "a blade touches within the window", role=Role.TARGET),
    Column("contact_duty", "number", "1", "share of the time in which any blade touches", role=Role.TARGET),
    Column("contact_impulse_per_turn_n_s", "number", "N s", "mean normal impulse a turn", role=Role.TARGET),
    Column("motion", "class", "", "class of motion of this stretch", words=Motion, role=Role.TARGET),
    Column(
        "motion_confidence",
        "number",
        "1",
        "chance that half the time step keeps the class; null where it was not measured",
        nullable=True,
        role=Role.DIAGNOSTIC,
    ),
)
WINDOWS_SCHEMA = table_schema(WINDOW_COLUMNS)


def signals_schema(recipe: Recipe) -> pa.Schema:
    """Return the schema of the table `signals`: names, time, inputs, targets.

    The metadata of a channel names its sensor. All channels are lists of the same length.
    """
    facts = {each["channel"]: each for each in channel_facts(recipe.sensing)}
    every = recipe_schema(recipe, signals=True)
    fields = []
    for field in _fixed((every.field(name) for name in _seen(every)), _length(recipe)):
        known = {key: str(value) for key, value in facts.get(field.name, {}).items() if value is not None}
        fields.append(field.with_metadata({**field.metadata, **known}))
    return pa.schema(fields, metadata=every.metadata)


def signals_row(run: Run, split: str) -> pa.Table:
    """Return the row of a run with status ok in the table `signals`. `split` is the name of its split."""
    whole = run_table(run, split=split)
    return _with_fixed(whole.select(_seen(whole.schema)), run)


def truth_schema(recipe: Recipe) -> pa.Schema:
    """Return the schema of the table `truth`: touches, orders by window, channels that no sensor could record."""
    every = recipe_schema(recipe, signals=True)
    return pa.schema(_fixed((every.field(name) for name in _hidden(every)), _length(recipe)), metadata=every.metadata)


def truth_row(run: Run, split: str) -> pa.Table:
    """Return the row of a run with status ok in the table `truth`. `split` is the name of its split."""
    whole = run_table(run, split=split)
    return _with_fixed(whole.select(_hidden(whole.schema)), run)


def _seen(types: pa.Schema) -> list[str]:
    return [field.name for role in SEEN for field in types if _role(field) is role]


def _hidden(types: pa.Schema) -> list[str]:
    """Return the columns of a row with signals that are neither in `signals` nor in `runs`, after names."""
    beyond = list(types)[types.names.index(FIRST_OF_SIGNALS) :]
    return [*OF_RUN, *(field.name for field in beyond if _role(field) not in SEEN)]


def windows_schema(_recipe: Recipe) -> pa.Schema:
    """Return the schema of the table `windows`."""
    return WINDOWS_SCHEMA


def window_rows(run: Run, split: str) -> pa.Table:
    """Return the rows of a run with status ok in the table `windows`: one row for each window of labels.

    Only windows that lie completely within the run's signals have a row. A sample belongs to a window if its time is
    not before the window's start, and before its end. Raises ValueError for a failed run.
    """
    if run.labels is None or run.recording is None:
        raise ValueError(f"{run.scenario.run_id} failed: it has no windows")
    rate, start = run.recording.sample_rate_hz, run.recording.start_seconds
    total = round(run.scenario.signal_seconds * rate)
    names = (run.scenario.run_id, run.scenario.machine_id, split)
    rows = []
    for number, (begin, end) in enumerate(window_edges_s(run.labels)):
        first, after = (math.ceil((time - start) * rate - 1e-6) for time in (begin, end))
        if first < 0 or after > total:
            continue
        windows = run.labels.windows
        motion, sure = windows.motion[number]
        values = (
            number, first, after - first, bool(windows.duty[number] > 0), float(windows.duty[number]),
            float(windows.impulse[number]), MOTION_CLASSES[motion], sure,
        )  # fmt: skip
        rows.append(dict(zip(WINDOWS_SCHEMA.names, (*names, *values), strict=True)))
    return pa.Table.from_pylist(rows, WINDOWS_SCHEMA)


def window_edges_s(labels: Labels) -> np.ndarray:
    """Return start and end of each window in s from the start of the record (windows, 2)."""
    starts = labels.windows.start
    if not starts.size:
        return np.zeros((0, 2))
    turns = labels.response.record_turns - WINDOW_TURNS * (starts.size - 1)
    return np.column_stack([starts, np.append(starts[1:], starts[-1] + 2 * np.pi * turns / labels.windows.speed[-1])])


def _with_fixed(table: pa.Table, run: Run) -> pa.Table:
    length = round(run.scenario.signal_seconds * run.scenario.sensing.sample_rate_hz)
    return table.cast(pa.schema(_fixed(table.schema, length), metadata=table.schema.metadata))


def _fixed(fields: Iterable[pa.Field], length: int) -> list[pa.Field]:
    """Return the fields with channels as lists of this length, so that every reader gets an array of runs and time."""
    channel = pa.list_(pa.float32())
    return [field.with_type(pa.list_(pa.float32(), length)) if field.type == channel else field for field in fields]


def _length(recipe: Recipe) -> int:
    return round(recipe.output.signal_seconds * recipe.sensing.sample_rate_hz)


def _role(field: pa.Field) -> Role:
    return Role(field.metadata[b"role"].decode())
