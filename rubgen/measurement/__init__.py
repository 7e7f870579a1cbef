"""From the true response to recorded channels."""

from rubgen.measurement.chain import margin_seconds
from rubgen.measurement.channel import Channel, Recording
from rubgen.measurement.measure import measure

__all__ = ["Channel", "Recording", "margin_seconds", "measure"]
