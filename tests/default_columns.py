"""The columns of a data set whose recipe names no sensors."""

from rubgen.io.columns import scalar_columns, signal_columns
from rubgen.sensors.load import default_sensor_set

SCALARS = scalar_columns(default_sensor_set())
SIGNALS = signal_columns(default_sensor_set(), clean=False)
CLEAN_SIGNALS = signal_columns(default_sensor_set(), clean=True)
CHANNELS = tuple(column.name for column in SIGNALS if column.kind == "signal")
