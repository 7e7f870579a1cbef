"""Accelerometer on the casing."""

from rubgen.scenario.taps import CasingAcceleration
from rubgen.sensors.kind import Description, Kind, label

KIND = Kind(
    describe=lambda sensor: Description(
        quantity="acceleration", axis="radial outward", location=f"casing at {sensor.angle_deg:g} deg"
    ),
    tap=lambda sensor: CasingAcceleration(name=f"casing_acc_{label(sensor.angle_deg)}", angle_deg=sensor.angle_deg),
)
