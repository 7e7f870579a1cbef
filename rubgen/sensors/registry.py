"""Every kind of sampled sensor, one line each, and the taps that a set of sensors needs."""

from __future__ import annotations

from dataclasses import replace

from rubgen.scenario.sensors import (
    Accelerometer,
    BladeStrain,
    CasingStrain,
    ClearanceProbe,
    ContactForceSensor,
    Proximity,
    SampledSensor,
    SensorSet,
    SupportForceSensor,
    TimingProbe,
    Torque,
)
from rubgen.scenario.taps import DEFAULT_TAPS, Tap, TipTiming
from rubgen.sensors import (
    accelerometer,
    blade_strain,
    casing_strain,
    contact_force,
    proximity,
    support_force,
    tip_clearance,
    torque,
)
from rubgen.sensors.kind import Description, Kind

KINDS: dict[type[SampledSensor], Kind] = {
    Proximity: proximity.KIND,
    Accelerometer: accelerometer.KIND,
    BladeStrain: blade_strain.KIND,
    CasingStrain: casing_strain.KIND,
    SupportForceSensor: support_force.KIND,
    ContactForceSensor: contact_force.KIND,
    Torque: torque.KIND,
    ClearanceProbe: tip_clearance.KIND,
}


def kind_of(sensor: SampledSensor) -> Kind:
    """The kind of a sampled sensor."""
    return KINDS[type(sensor)]


def describe(sensor: SampledSensor) -> Description:
    """What the sensor's channel is."""
    return kind_of(sensor).describe(sensor)


def tap_of(sensor: SampledSensor) -> Tap:
    """The true signal that a sensor sees: one of those that every run has, or its own."""
    wanted = kind_of(sensor).tap(sensor)
    return next((tap for tap in DEFAULT_TAPS if replace(tap, name=wanted.name) == wanted), wanted)


def taps_of(sensors: SensorSet) -> tuple[Tap, ...]:
    """The taps that every run has, then those that this set needs beside them, each once; the labels look at all."""
    taps = dict.fromkeys([*DEFAULT_TAPS, *(tap_of(sensor) for sensor in sensors.sampled)])
    probes = [
        TipTiming(name=probe.name, angle_deg=probe.angle_deg, axial_m=probe.axial_m)
        for probe in sensors.sensors
        if isinstance(probe, TimingProbe)
    ]
    return (*taps, *probes)
