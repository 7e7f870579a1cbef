"""The table of runs, checked against the manifest, and DataFrames of runs and touches."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from rubgen.arrays import FloatArray
from rubgen.dataset.manifest import Manifest
from rubgen.errors import UserError
from rubgen.io.columns import every_scalar
from rubgen.labels.compact_record import CompactRecord, named_scalars
from rubgen.labels.labels import Motion
from rubgen.scenario import Sensing
from rubgen.scenario.run_id import run_id_of
from rubgen.sensors.sensor_set import SensorSet

if TYPE_CHECKING:
    import pandas as pd

FLAGS_AND_COUNTS = ("rub", "blades_touched", "contact_touches")
NUMBERS = ("contact_duty", "contact_impulse_per_turn_n_s", "speed_rpm", "sample_rate_hz")
MOTIONS = ("motion", "motion_blisk", "motion_casing")
FIRST_SAMPLE = "first_sample_s"
"""Attribute of a frame of touches: the time of the first sample from the record's start, in s."""
UNITS = {
    "start_s": "s", "end_s": "s", "blade": "", "angle_rad": "rad", "impulse_n_s": "N s", "friction_work_j": "J",
    "normal_work_j": "J",
}  # fmt: skip


def runs_frame(table: pa.Table, sensors: SensorSet) -> pd.DataFrame:
    """Turn the table of `runs.parquet` into a DataFrame with `run_id` as the index. Failed runs are included.

    `table` has words for classes; `sensors` is the sensor set of the set. Flags are pandas "boolean", integers "Int64",
    texts and classes "string". Of a failed run, and where a value is undefined, they are <NA>: a flag can still select
    rows. Numbers are float64 with NaN. Lists are numpy arrays, or None where a run has no list. `attrs["units"]` and
    `attrs["meanings"]` map each column to its unit and its meaning.
    """
    frame: pd.DataFrame = table.to_pandas(types_mapper=_nullable)
    frame = frame.set_index("run_id")
    every = every_scalar(sensors)
    columns = {column.name: column for column in every if column.name in frame}
    frame.attrs = {
        "units": {name: column.unit for name, column in columns.items()},
        "meanings": {name: column.meaning for name, column in columns.items()},
    }
    return frame


def _nullable(kind: pa.DataType) -> Any:
    """Return the pandas type of a column, or None to leave it to pyarrow."""
    import pandas as pd

    return {pa.bool_(): pd.BooleanDtype(), pa.int64(): pd.Int64Dtype(), pa.string(): pd.StringDtype()}.get(kind)


def check_runs(table: pa.Table, manifest: Manifest, path: Path) -> None:
    """Check `runs.parquet` against the manifest: names, status counts, and the main labels of good runs.

    - table: the content of the file at `path`, with words for classes (`with_words`).
    - manifest: the manifest of the set.

    Raises UserError, one line with file and run, where they do not fit.
    """
    names = table["run_id"].to_pylist()
    if names != [run_id_of(index) for index in range(manifest.runs)]:
        raise UserError(f"{path}: its runs are not the {manifest.runs} of the manifest; generate the set again")
    if Counter(table["status"].to_pylist()) != Counter(manifest.status):
        raise UserError(f"{path}: its status counts are not those of the manifest; generate the set again")
    good = table.filter(pc.equal(table["status"], "ok"))
    for name in (*FLAGS_AND_COUNTS, *NUMBERS, *MOTIONS):
        wrong = pc.is_null(good[name])
        if name in NUMBERS:
            wrong = pc.invert(pc.fill_null(pc.is_finite(good[name]), False))
        elif name in MOTIONS:
            wrong = pc.invert(pc.is_in(good[name], pa.array([motion.value for motion in Motion])))
        where = pc.index(wrong, True).as_py()
        if where >= 0:
            run_id, value = good["run_id"][where].as_py(), good[name][where].as_py()
            raise UserError(f"{path}: {run_id}: {name} = {value!r:.60} of a good run; generate the set again")


def touches_frame(record: CompactRecord, sensing: Sensing, seconds: float) -> pd.DataFrame:
    """Make a DataFrame of the touches of a run: one row for each touch of a blade, in order of their start.

    - record: the touches of the run, from `read_touches`.
    - sensing: the sensors of the run, from which the first sample follows.
    - seconds: length of the signals, s.

    The columns are the names in UNITS. `start_s` and `end_s` count from the first sample of the signals: earlier
    touches have negative times. `blade` counts from 0. `angle_rad` is the polar angle on the casing in [0, 2 pi), a
    mean weighted by impulse. `impulse_n_s` is the normal impulse. `friction_work_j` and `normal_work_j` are the works
    of the contact force on blade and casing, along the surface and normal to it. The friction work is <= 0, and without
    restitution the normal work is too. `attrs["units"]` maps each column to its unit. `attrs["first_sample_s"]` is the
    time of the first sample from the start of the record, s.
    """
    import pandas as pd

    from rubgen.measurement.chain import start_seconds

    scalars = named_scalars(record["scalars"].tolist())
    dt, turns = scalars["dt"], record["turn_steps"]
    steps = int(turns[-1]) if turns.size else int(scalars["record_turns"] * scalars["steps_per_turn"])
    first = start_seconds(sensing, seconds, steps=steps, dt=dt)
    start: FloatArray = record["start_step"] * dt - first
    frame = pd.DataFrame(
        {
            "start_s": start,
            "end_s": start + record["steps"] * dt,
            "blade": record["blade"].astype(np.int64),
            "angle_rad": record["angle"].astype(np.float64),
            "impulse_n_s": record["impulse"].astype(np.float64),
            "friction_work_j": record["friction_loss"].astype(np.float64),
            "normal_work_j": record["normal_loss"].astype(np.float64),
        }
    )
    frame = frame.sort_values("start_s", kind="stable", ignore_index=True)
    frame.attrs = {"units": dict(UNITS), FIRST_SAMPLE: first}
    return frame
