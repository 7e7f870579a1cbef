"""Probe of the gap between the blade tips and the casing."""

from rubgen.scenario.taps import TipClearance
from rubgen.sensors.kind import Description, Kind, label

KIND = Kind(
    describe=lambda sensor: Description(quantity="gap", axis="radial", location=f"casing at {sensor.angle_deg:g} deg"),
    tap=lambda sensor: TipClearance(name=f"tip_clearance_{label(sensor.angle_deg)}", angle_deg=sensor.angle_deg),
)
