"""The touches of one run as a DataFrame, from what is kept of it."""

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

    kept = {name: np.asarray(table[name][0].values) for name in COLUMNS}
    scalars = dict(zip(SCALARS, kept["scalars"].tolist(), strict=True))
    dt, turns = scalars["dt"], kept["turn_steps"]
    steps = int(turns[-1]) if turns.size else int(scalars["record_turns"] * scalars["steps_per_turn"])
    first = start_seconds(sensing, seconds, steps=steps, dt=dt)
    start: FloatArray = kept["start_step"] * dt - first
    frame = pd.DataFrame(
        {
            "start_s": start,
            "end_s": start + kept["steps"] * dt,
            "blade": kept["blade"].astype(np.int64),
            "angle_rad": kept["angle"].astype(np.float64),
            "impulse_n_s": kept["impulse"].astype(np.float64),
            "friction_work_j": kept["friction_loss"].astype(np.float64),
            "normal_work_j": kept["normal_loss"].astype(np.float64),
        }
    )
    frame = frame.sort_values("start_s", kind="stable", ignore_index=True)
    frame.attrs = {"units": dict(UNITS)}
    return frame
