"""Runs as Parquet: one row for each run, scalars and labels as columns, each recorded channel one list<float32> column.

zstd, a checksum on every page, an index of pages. Columns of texts and of recorded channels have dictionaries: an ADC
has few values, so `signals/` is 14 to 27 % smaller than with BYTE_STREAM_SPLIT, which some readers lack. Only files in
`truth/` and `sections/` use BYTE_STREAM_SPLIT, for their floating-point columns without a dictionary. Page ends depend
on the content (content-defined chunking), so that stores which compare pages upload only changed pages. The bytes
depend only on the rows.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from rubgen.arrays import FloatArray
from rubgen.io.columns import DRAWING, IN_RUNS_ALONE, Column, Role, scalar_columns, signal_columns
from rubgen.io.files import write_durably
from rubgen.io.parquet.features import features_json, is_list
from rubgen.io.parquet.words import with_numbers
from rubgen.labels.classes import class_numbers
from rubgen.labels.faults import fault_labels
from rubgen.labels.registry import ENERGY_LABELS
from rubgen.labels.to_json import labels_to_json, window_labels
from rubgen.measurement.channel import Recording
from rubgen.measurement.motion import contact_intervals
from rubgen.scenario import Recipe
from rubgen.scenario.machines.keys import MachineKey, machine_values, own_keys
from rubgen.scenario.run_id import run_id_of
from rubgen.scenario.surroundings import surroundings_values
from rubgen.scenario.vary import varied_values
from rubgen.sensors.load import default_sensor_set
from rubgen.sensors.sensor_set import SensorSet

if TYPE_CHECKING:  # Run carries the solver's imports; who reads a file needs none of them
    from rubgen.pipeline import Run

TYPES = {
    "text": pa.string(),
    "texts": pa.list_(pa.string()),
    "flag": pa.bool_(),
    "class": pa.int64(),
    "integer": pa.int64(),
    "number": pa.float64(),
    "integers": pa.list_(pa.int64()),
    "numbers": pa.list_(pa.float64()),
    "signal": pa.list_(pa.float32()),
}
COMPRESSION_LEVEL = 3


def schema(
    *,
    signals: bool,
    clean: bool = False,
    sensors: SensorSet | None = None,
    surroundings: bool = False,
    faults: tuple[str, ...] = (),
    machines: tuple[MachineKey, ...] = (),
    drawing: Collection[str] = (),
) -> pa.Schema:
    """Return the Arrow schema of `runs.parquet`, or with `signals` of the data files. Fields have metadata.

    - signals: include the recorded channels, touches and windows of each run.
    - clean: include the clean channels (without noise).
    - sensors: the sensor set of the runs; None is the default set.
    - surroundings: include the levels of the disturbances from the surroundings.
    - faults: kinds of fault whose labels are included.
    - machines: keys of virtual machines whose values are included.
    - drawing: names in DRAWING of the tables of the recipe whose columns are included.
    """
    return _schema(signals, clean, sensors or default_sensor_set(), surroundings, faults, machines, tuple(drawing))


@lru_cache(maxsize=32)  # it takes as long as a row, and rows of a set share it
def _schema(
    signals: bool,
    clean: bool,
    sensors: SensorSet,
    surroundings: bool,
    faults: tuple[str, ...],
    machines: tuple[MachineKey, ...],
    drawing: tuple[str, ...],
) -> pa.Schema:
    columns = scalar_columns(sensors, surroundings=surroundings, faults=faults, machines=machines, drawing=drawing)
    columns += signal_columns(sensors, clean=clean) if signals else ()
    return table_schema(columns)


def recipe_schema(recipe: Recipe, *, signals: bool) -> pa.Schema:
    """Return the Arrow schema of the files of the data set that `recipe` makes.

    With `signals` it is the schema of a whole row with signals, whose columns the tables `signals` and `truth` share
    out. Else it is the schema of `runs.parquet`.
    """
    sensing, around = recipe.sensing, recipe.surroundings
    return schema(
        signals=signals,
        clean=sensing.keep_clean,
        sensors=sensing.set,
        surroundings=around is not None,
        faults=recipe.fault_kinds,
        machines=recipe.machine_keys,
        drawing=drawing_of(recipe, signals=signals),
    )


def recipe_columns(recipe: Recipe) -> tuple[Column, ...]:
    """Return the columns of `runs.parquet` in the data set that `recipe` makes."""
    return scalar_columns(
        recipe.sensing.set,
        surroundings=recipe.surroundings is not None,
        faults=recipe.fault_kinds,
        machines=recipe.machine_keys,
        drawing=drawing_of(recipe),
    )


def drawing_of(recipe: Recipe, *, signals: bool = False) -> list[str]:
    """Return the names in DRAWING whose columns the files of the recipe's set have.

    The files are `runs.parquet`, or with `signals` the data files.
    """
    has = {"twins": recipe.twins is not None, "balance": recipe.balance is not None, "merged": len(recipe.sources) > 1}
    return [name for name in DRAWING if has[name] and not (signals and name in IN_RUNS_ALONE)]


def run_table(run: Run, *, split: str = "train", signals: bool = True) -> pa.Table:
    """Make the row of one run: identity, parameters, labels and energies, and with `signals` its channels and touches.

    With `signals` it also has the labels of windows. Without it these columns are left out. Classes are numbers.
    `split` is the name of the split of the run. A failed run has null labels, energies, channels and touches. Raises
    ValueError where a label has no column.
    """
    around = run.scenario.surroundings
    row = _identity(run, split) | varied_values(run.scenario) | _operation(run)
    if around:
        row |= surroundings_values(around)
    if run.scenario.virtual:
        row |= {"machine_number": run.scenario.virtual.number, "machine_candidate": run.scenario.virtual.candidate}
        row |= machine_values(run.scenario.machine)
    if run.labels is not None:
        row |= labels_to_json(run.labels)
        row |= {each.name: each.value(run.response.energy) for each in ENERGY_LABELS}
    if signals and run.recording is not None and run.labels is not None:
        row |= _signals(run.recording) | _touches(run, run.recording) | window_labels(run.labels)
    row |= fault_labels(run.scenario, run.response)
    row = with_numbers(row)
    drawn: list[str] = []
    sensing = run.scenario.sensing
    if run.scenario.pairing and not signals:
        drawn.append("twins")
        row["twin_of"] = run.scenario.partner
    if run.scenario.balance:
        drawn.append("balance")
        row |= {f"balance_{name}": getattr(run.scenario.balance, name) for name in ("cell", "tries", "seen")}
    if run.scenario.merged and not signals:
        drawn.append("merged")
        row["merged_from"] = merged_from(run.scenario.merged.source, run.scenario.index)
    types = schema(
        signals=signals,
        clean=sensing.keep_clean,
        sensors=sensing.set,
        surroundings=around is not None,
        faults=run.scenario.fault_kinds,
        machines=own_keys(frame=run.scenario.machine.frame is not None) if run.scenario.virtual else (),
        drawing=drawn,
    )
    unknown = sorted(set(row) - set(types.names))
    if unknown:
        raise ValueError(f"no column for {', '.join(unknown)}")
    return pa.table({field.name: pa.array([row.get(field.name)], field.type) for field in types}, schema=types)


def merged_from(source: str, index: int) -> str:
    """Return the value of the column `merged_from` for run number `index` of a source: `<source>/<name of the run>`.

    `source` is the text of digits that names the source, the beginning of a digest.
    """
    return f"{source}/{run_id_of(index)}"


def write_table(tables: Iterable[pa.Table], types: pa.Schema, path: Path) -> int:
    """Write tables of schema `types` to the file at `path`, each as one row group. Return the number of rows written.

    The file is complete or not written at all. An existing file is replaced.
    """
    rows = 0

    def write(part: Path) -> None:
        nonlocal rows
        with part.open("wb") as stream, pq.ParquetWriter(stream, types, **_settings(types)) as writer:
            for table in tables:
                writer.write_table(table, row_group_size=max(table.num_rows, 1))
                rows += table.num_rows

    write_durably(path, write)
    return rows


def write_parquet(run: Run, path: Path) -> None:
    """Write one run as a Parquet file of one row, with its signals. An existing file is replaced.

    Raises OSError where the file cannot be written.
    """
    table = run_table(run)
    write_table([table], table.schema, path)


def table_schema(columns: Iterable[Column]) -> pa.Schema:
    """Return the Arrow schema of a table with these columns.

    Its metadata also describes them to Hugging Face's `datasets`.
    """
    columns = list(columns)
    fields = [_field(column) for column in columns]
    return pa.schema(fields, metadata={"huggingface": features_json(columns, fields)})


def _field(column: Column) -> pa.Field:
    facts = {"unit": column.unit, "meaning": column.meaning, "role": column.role.value}
    if column.words:
        facts["classes"] = json.dumps(class_numbers(column.words))
    return pa.field(column.name, TYPES[column.kind], metadata=facts)


def _settings(types: pa.Schema) -> dict[str, Any]:
    # The leaf of a list must be named: the plain column's name is silently ignored.
    leaves = {field.name: f"{field.name}.list.element" if is_list(field.type) else field.name for field in types}
    values = {field.name: field.type.value_type if is_list(field.type) else field.type for field in types}
    single = [name for name, kind in values.items() if kind == pa.float32()]
    roles = {field.name: (field.metadata or {}).get(b"role", b"").decode() for field in types}
    recorded = [name for name in single if roles[name] and not name.endswith("_clean")]
    split = bool(single) and all(roles[name] != Role.INPUT for name in recorded)
    floats = [leaves[name] for name, kind in values.items() if pa.types.is_floating(kind) and name not in recorded]
    return {
        "compression": "zstd",
        "compression_level": COMPRESSION_LEVEL,
        "use_dictionary": [
            leaves[name] for name, kind in values.items() if pa.types.is_string(kind) or name in recorded
        ],
        "use_byte_stream_split": floats if split else False,
        "write_page_checksum": True,
        "write_page_index": True,
        "use_content_defined_chunking": True,
    }


def _identity(run: Run, split: str) -> dict[str, object]:
    return {
        "run_id": run.scenario.run_id,
        "machine_id": run.scenario.machine_id,
        "split": split,
        "seed": run.scenario.seed,
        "status": run.response.status.code,
        "reason": run.response.reason,
    }


def _operation(run: Run) -> dict[str, object]:
    return {
        "steps_per_turn": run.response.steps_per_turn,
        "settle_turns": run.response.settle_turns,
        "record_turns": run.response.record_turns,
        "sample_rate_hz": run.scenario.sensing.sample_rate_hz,
    }


def _signals(recording: Recording) -> dict[str, object]:
    values: dict[str, object] = {
        "signal_start_s": recording.start_seconds,
        "rotation_angle_rad": recording.rotation_angle,
        "once_per_rev_s": recording.once_per_rev,
    }
    for name, channel in recording.channels.items():
        values[name] = channel.values
        if channel.clean is not None:
            values[f"{name}_clean"] = channel.clean
    for name, seen in recording.tip_timing.items():
        values |= {f"{name}_s": seen.time, f"{name}_blade": seen.blade, f"{name}_true_m": seen.true_displacement}
    return values


def _touches(run: Run, recording: Recording) -> dict[str, object]:
    """Return the columns of the touches that overlap the recording, in order of their start."""
    touches = contact_intervals(run.response, recording)
    order = np.argsort(touches.start, kind="stable")
    return {
        "touch_start_s": touches.start[order],
        "touch_end_s": (touches.start + touches.duration)[order],
        "touch_blade": touches.blade[order],
        "touch_angle_rad": _single(touches.angle[order]),
        "touch_impulse_n_s": _single(touches.impulse[order]),
        "touch_friction_work_j": _single(touches.friction_loss[order]),
    }


def _single(values: FloatArray) -> FloatArray:
    """Round values to single precision, so that they compress."""
    return np.asarray(values.astype(np.float32), dtype=np.float64)
