"""Strain gauge at the root of a blade."""

from rubgen.scenario.taps import RootStrain
from rubgen.sensors.kind import Description, Kind

KIND = Kind(
    describe=lambda sensor: Description(
        quantity="blade strain", axis="spanwise", location=f"root of blade {sensor.blade}"
    ),
    tap=lambda sensor: RootStrain(name=f"root_strain_{sensor.blade}", blade=sensor.blade),
)
