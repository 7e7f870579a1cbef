"""The sensors that look at a tap of the response: one line each. Ranges and noise are explained in docs/sensors.md."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Probe:
    """One sensor: its channel's name, the tap it sees, what it measures, range and noise rms at `noise = 1`."""

    name: str
    tap: str
    unit: str
    quantity: str
    axis: str
    location: str
    range_min: float
    range_max: float
    noise_rms: float


def _proximity(name: str, tap: str, axis: str) -> Probe:
    return Probe(name, tap, "m", "displacement", axis, "disk centre", -2e-3, 2e-3, 5e-7)


def _casing_acceleration(angle: int) -> Probe:
    name = f"casing_acc_{angle}"
    return Probe(name, name, "m/s2", "acceleration", "radial outward", f"casing at {angle} deg", -5e4, 5e4, 1.0)


def _support_force(name: str, axis: str) -> Probe:
    return Probe(name, name, "N", "force", axis, "disk support", -2.5e5, 2.5e5, 10.0)


def _tip_clearance(angle: int) -> Probe:
    name = f"tip_clearance_{angle}"
    return Probe(name, name, "m", "gap", "radial", f"casing at {angle} deg", -1e-3, 1.2e-2, 5e-6)


# A sensor's place decides which random numbers it gets: append new ones at the end.
PROBES: tuple[Probe, ...] = (
    _proximity("proximity_x", "blisk_x", "X"),
    _proximity("proximity_y", "blisk_y", "Y"),
    _casing_acceleration(0),
    _casing_acceleration(90),
    _casing_acceleration(180),
    _casing_acceleration(270),
    _support_force("support_force_x", "X"),
    _support_force("support_force_y", "Y"),
    Probe("contact_force", "contact_force", "N", "contact force", "normal", "all blade tips", -1e5, 1e5, 5.0),
    _tip_clearance(0),
    _tip_clearance(90),
)
