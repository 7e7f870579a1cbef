"""`runs.parquet` as a DataFrame in which a missing value leaves the type of its column alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pyarrow as pa

from rubgen.io.columns import scalar_columns
from rubgen.sensors.sensor_set import SensorSet

if TYPE_CHECKING:
    import pandas as pd


def runs_frame(table: pa.Table, sensors: SensorSet) -> pd.DataFrame:
    """The table of all runs, failed ones too, with `run_id` as the index and as no column.

    Flags are pandas "boolean", integers "Int64", text "string": a failed run has <NA> there, and a flag still selects
    rows. Numbers are float64 with NaN. Lists are numpy arrays, None where a run has none. `attrs["units"]` and
    `attrs["meanings"]` map each column to its unit and to what it means.
    """
    frame: pd.DataFrame = table.to_pandas(types_mapper=_nullable)
    frame = frame.set_index("run_id")
    columns = {column.name: column for column in scalar_columns(sensors) if column.name in frame}
    frame.attrs = {
        "units": {name: column.unit for name, column in columns.items()},
        "meanings": {name: column.meaning for name, column in columns.items()},
    }
    return frame


def _nullable(kind: pa.DataType) -> Any:
    """The pandas type of a column; None leaves it to pyarrow."""
    import pandas as pd

    return {pa.bool_(): pd.BooleanDtype(), pa.int64(): pd.Int64Dtype(), pa.string(): pd.StringDtype()}.get(kind)
