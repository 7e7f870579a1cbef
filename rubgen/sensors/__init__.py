"""Virtual sensors: from the true response to recorded channels."""

from rubgen.sensors.chain import margin_seconds
from rubgen.sensors.channel import Channel, Recording
from rubgen.sensors.measure import measure
from rubgen.sensors.registry import taps_of

__all__ = ["Channel", "Recording", "margin_seconds", "measure", "taps_of"]
