"""Proximity probe: displacement of the disk centre, and the profile of the shaft that it cannot tell from it."""

from __future__ import annotations

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.scenario.sensors import Proximity, SensorSet
from rubgen.scenario.taps import CentreDisplacement
from rubgen.sensors.kind import Description, Kind, along, label


def describe(sensor: Proximity) -> Description:
    """In V it is the gap voltage, which is no displacement to whoever reads the channel."""
    quantity = "gap voltage" if sensor.unit == "V" else "displacement"
    return Description(quantity=quantity, axis=along(sensor.angle_deg), location="disk centre")


def runout(angle: FloatArray, sensors: SensorSet) -> FloatArray:
    """Profile of the shaft at angles from its mark, m: sum of amplitude cos(order (angle - phase))."""
    profile = np.zeros_like(angle)
    for part in sensors.shaft_runout:
        profile += part.amplitude_m * np.cos(part.order * (angle - np.deg2rad(part.phase_deg)))
    return profile


def disturb(sensor: Proximity, signal: FloatArray, angle: FloatArray, sensors: SensorSet) -> FloatArray:
    """A probe at angle phi sees the shaft's profile at phi - theta: high spots come nearer."""
    if not sensors.shaft_runout:
        return signal
    return signal + runout(np.deg2rad(sensor.angle_deg) - angle, sensors)


KIND = Kind(
    describe=describe,
    tap=lambda sensor: CentreDisplacement(name=f"blisk_{label(sensor.angle_deg)}", angle_deg=sensor.angle_deg),
    disturb=disturb,
)
