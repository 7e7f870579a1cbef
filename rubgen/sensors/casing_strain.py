"""Strain gauge on the outer face of the casing, around the ring."""

from rubgen.scenario.taps import RingStrain
from rubgen.sensors.kind import Description, Kind, label

KIND = Kind(
    describe=lambda sensor: Description(
        quantity="casing strain", axis="hoop", location=f"casing at {sensor.angle_deg:g} deg, outer face"
    ),
    tap=lambda sensor: RingStrain(name=f"ring_strain_{label(sensor.angle_deg)}", angle_deg=sensor.angle_deg),
)
