"""The sensors of a data set as a table: one row for each sensor, its values as numbers."""

import pyarrow as pa

from rubgen.io.channel_facts import FACTS, channel_facts
from rubgen.scenario import Sensing

_TYPES = {"text": pa.string(), "number": pa.float64(), "integer": pa.int64()}
SENSORS_SCHEMA = pa.schema(
    [pa.field(name, _TYPES[kind], metadata={"meaning": meaning}) for name, (kind, meaning) in FACTS.items()]
)


def sensors_table(sensing: Sensing) -> pa.Table:
    """Return the table of `sensors.parquet`: FACTS of each sensor, in the order of the set."""
    return pa.Table.from_pylist(channel_facts(sensing), SENSORS_SCHEMA)
