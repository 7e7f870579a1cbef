"""The touches of one run as a DataFrame, from its compact record."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from rubgen.arrays import FloatArray
from rubgen.labels.compact_record import SCALARS, TOUCHES
from rubgen.scenario import Sensing

if TYPE_CHECKING:
    import pandas as pd

COLUMNS = ("scalars", "turn_steps", *TOUCHES)
"""The columns of the section files that are read."""
UNITS = {
    "start_s": "s", "end_s": "s", "blade": "", "angle_rad": "rad", "impulse_n_s": "N s", "friction_work_j": "J",
    "normal_work_j": "J",
}  # fmt: skip


def touches_frame(table: pa.Table, sensing: Sensing, seconds: float) -> pd.DataFrame:
    """One row a touch of a blade, in order of its start, from the row of a run in `sections/`.

    `start_s` and `end_s` count from the first sample of the signals, which last `seconds`: touches before it have
    negative times. `angle_rad` is the polar angle on the casing, mean by impulse; the works are <= 0. `attrs["units"]`
    maps each column to its unit.
    """
    import pandas as pd

    from rubgen.measurement.chain import start_seconds

    record = {name: np.asarray(table[name][0].values) for name in COLUMNS}
    scalars = dict(zip(SCALARS, record["scalars"].tolist(), strict=True))
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
    frame.attrs = {"units": dict(UNITS)}
    return frame
