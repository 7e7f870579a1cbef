"""Facts about recorded channels as values: kind, unit, place, range, resolution, noise."""

from typing import Any

from rubgen.scenario import Sensing
from rubgen.sensors.kinds.blade_tip_timing import TimingProbe
from rubgen.sensors.kinds.once_per_rev import OncePerRev
from rubgen.sensors.sensor import SampledSensor, Sensor

FACTS: dict[str, tuple[str, str]] = {
    "channel": ("text", "name of the sensor and of its channel"),
    "kind": ("text", "kind of sensor"),
    "unit": ("text", "unit of the channel and of the numbers of this row"),
    "quantity": ("text", "measured quantity"),
    "axis": ("text", "direction in which it is measured"),
    "location": ("text", "where it is measured"),
    "angle_deg": ("number", "angle of the sensor from +X; null where it has none"),
    "blade": ("integer", "blade that carries it; null where none does"),
    "axial_m": ("number", "axial place from the middle of the tips' chords; null where it has none"),
    "sample_rate_hz": ("number", "samples a second; null for events"),
    "range_min": ("number", "lower end of the range"),
    "range_max": ("number", "upper end of the range"),
    "resolution": ("number", "step of the converter"),
    "noise_rms": ("number", "white noise, rms"),
    "bandwidth_hz": ("number", "low-pass of the sensor; null without"),
    "resonance_hz": ("number", "resonance of the sensor; null without"),
    "sensitivity_v_per_m": ("number", "volts per metre of a shaft probe that records volts; null for others"),
}
"""Each fact: type and meaning."""


def channel_facts(sensing: Sensing) -> list[dict[str, Any]]:
    """Return the FACTS of each sensor, in the order of the sensor set. A fact that a sensor does not have is None."""
    return [dict.fromkeys(FACTS) | _facts(sensor, sensing) for sensor in sensing.set.sensors]


def _facts(sensor: Sensor, sensing: Sensing) -> dict[str, Any]:
    own = {key: getattr(sensor, key, None) for key in ("kind", "angle_deg", "blade", "axial_m")}
    own["channel"] = sensor.name
    if isinstance(sensor, OncePerRev):
        event = "pulse and its arrival times"
        return own | {"unit": "1", "quantity": event, "location": "shaft", "sample_rate_hz": sensing.sample_rate_hz}
    if isinstance(sensor, TimingProbe):
        return own | {"unit": "s", "quantity": "arrival times of blades", "location": "casing"}
    if not isinstance(sensor, SampledSensor):
        return own
    low, high = sensor.full_range
    about = sensor.description
    volts = sensor.unit == "V"
    return own | {
        "unit": sensor.unit,
        "quantity": about.quantity,
        "axis": about.axis,
        "location": about.location,
        "sample_rate_hz": sensing.sample_rate_hz,
        "range_min": low,
        "range_max": high,
        "resolution": (high - low) / 2 ** (sensor.adc_bits or sensing.adc_bits),
        "noise_rms": sensing.noise * sensor.noise_rms,
        "bandwidth_hz": sensor.bandwidth_hz,
        "resonance_hz": sensor.resonance_hz,
        "sensitivity_v_per_m": getattr(sensor, "sensitivity_v_per_m", None) if volts else None,
    }
