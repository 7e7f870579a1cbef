"""Quantities that vibration analysts read, under their names, from recorded channels and pulses alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.errors import UserError
from rubgen.features.plan import shaft_pairs
from rubgen.features.turns import by_turn, circles
from rubgen.machine.problems import nearest
from rubgen.sensors.kinds.accelerometer import Accelerometer
from rubgen.sensors.kinds.housing_accelerometer import HousingAccelerometer
from rubgen.sensors.kinds.once_per_rev import OncePerRev
from rubgen.sensors.kinds.proximity import Proximity
from rubgen.sensors.sensor import SampledSensor

if TYPE_CHECKING:
    import pandas as pd

    from rubgen.dataset.reading.open import DataSet

QUANTITIES = {
    "overall_peak_to_peak": "largest minus smallest value",
    "overall_rms": "root mean square without the mean",
    "amplitude_1x": "peak amplitude at the speed",
    "phase_1x_deg": "phase lag of 1X: angle from the pulse to the maximum, 0 to 360",
    "amplitude_2x": "peak amplitude at twice the speed",
    "phase_2x_deg": "phase lag of 2X: angle from the pulse to the maximum, 0 to 360",
    "not_1x_rms": "root mean square without the mean and without 1X",
    "s_max": "largest distance of the shaft from its mean place (ISO 20816-1), of a pair of shaft probes",
    "gap_voltage_v": "mean voltage of a shaft probe that records volts",
    "velocity_rms_mm_per_s": "rms velocity from 10 to 1,000 Hz (ISO 20816-1) of an accelerometer, integrated",
}
"""Each quantity, in the unit of the channel where its name has none, with its definition."""
VELOCITY_BAND_HZ = (10.0, 1000.0)
ZONES = "ABCD"

Limits = Mapping[str, tuple[str, float, float, float]]


def condition(data: DataSet, limits: Limits | None = None, *, runs: Sequence[str] | None = None) -> pd.DataFrame:
    """Compute QUANTITIES of each channel of good runs: a DataFrame with one row for each run and channel.

    - data: the data set.
    - limits: for a channel a quantity and the upper limits of the zones A, B and C, in the unit of the quantity, such
      as {"proximity_x": ("overall_peak_to_peak", 80e-6, 120e-6, 180e-6)}. Only with limits there is a column `zone`: A
      to D, null for other channels and where the quantity is NaN. A value at a limit is in the lower zone. rubgen has
      no limits of its own: the limits of ISO 20816 depend on the machine.
    - runs: names of good runs; None takes all good runs.

    The channels are `data.inputs` without the pulse. Orders are averaged over whole turns between two recorded pulses
    (order tracking). Quantities that a channel cannot have are NaN, such as orders without a once_per_rev sensor. The
    column `unit` is the unit of the channel. `attrs["meanings"]` has the definitions. Raises UserError for a failed or
    unknown run, an unknown channel or quantity in `limits`, and limits that do not rise from above 0.
    """
    import pandas as pd

    names = [each.name for each in data.sensors.sensors if isinstance(each, SampledSensor) and each.name in data.inputs]
    checked = _checked(limits or {}, names)
    if runs is not None:
        for run_id in runs:
            data.check_has_signals(run_id)
    chosen = list(data.ok.index) if runs is None else list(runs)
    found = []
    for run_id, signals, pulses in data.recorded(chosen, names):
        stacked = np.array([signals[name] for name in names], dtype=np.float64)
        values = _quantities(data, names, stacked, pulses)
        found += [
            {"run_id": run_id, "channel": name, "unit": data.units[name]}
            | {key: float(values[key][row]) for key in QUANTITIES}
            for row, name in enumerate(names)
        ]
    frame = pd.DataFrame(found, columns=["run_id", "channel", "unit", *QUANTITIES])
    if checked:
        frame["zone"] = pd.array([_zone(row, checked) for row in found], dtype="string")
    frame.attrs = {"meanings": dict(QUANTITIES)}
    return frame


def _quantities(data: DataSet, names: Sequence[str], signals: FloatArray, pulses: FloatArray) -> dict[str, FloatArray]:
    """Return each of QUANTITIES of the channels (channels, samples), as (channels,)."""
    sensors = {each.name: each for each in data.sensors.sensors}
    rate = data.sample_rate_hz
    has_pulses = any(isinstance(each, OncePerRev) for each in data.sensors.sensors)
    turned = by_turn(signals, rate, pulses if has_pulses else pulses[:0])
    one, two = circles(turned, (1, 2))
    nothing = np.full(len(names), np.nan)
    rest = np.maximum(turned.var(axis=(1, 2)) - 2 * np.abs(one) ** 2, 0) if turned.shape[1] else nothing
    s_max, gap, velocity = nothing.copy(), nothing.copy(), nothing.copy()
    for first, second, *angles in shaft_pairs(data.sensors, names):
        rows = [names.index(first), names.index(second)]
        s_max[rows] = _s_max(signals[rows], (angles[0], angles[1]))
    for row, name in enumerate(names):
        sensor = sensors[name]
        if isinstance(sensor, Proximity) and sensor.unit == "V":
            gap[row] = signals[row].mean()
        if isinstance(sensor, Accelerometer | HousingAccelerometer):
            velocity[row] = 1e3 * _velocity_rms(signals[row] / sensor.scale[0], rate)
    return {
        "overall_peak_to_peak": np.ptp(signals, axis=1),
        "overall_rms": signals.std(axis=1),
        "amplitude_1x": 2 * np.abs(one),
        "phase_1x_deg": _lag(one),
        "amplitude_2x": 2 * np.abs(two),
        "phase_2x_deg": _lag(two),
        "not_1x_rms": np.sqrt(rest),
        "s_max": s_max,
        "gap_voltage_v": gap,
        "velocity_rms_mm_per_s": velocity,
    }


def _lag(circle: np.ndarray) -> FloatArray:
    return np.asarray(np.mod(-np.rad2deg(np.angle(circle)), 360), dtype=np.float64)


def _s_max(probes: FloatArray, angles_deg: tuple[float, float]) -> float:
    """Return the largest distance of the shaft from its mean place, from two probes (2, samples) at these angles."""
    angle = np.deg2rad(angles_deg)
    place = np.linalg.solve(np.column_stack([np.cos(angle), np.sin(angle)]), probes)
    return float(np.hypot(*(place - place.mean(axis=1, keepdims=True))).max())


def _velocity_rms(acceleration: FloatArray, rate_hz: float) -> float:
    """Return the rms velocity in m/s of an acceleration (samples,) in m/s2, within VELOCITY_BAND_HZ."""
    lines = np.fft.rfft(acceleration) / acceleration.size
    frequency = np.fft.rfftfreq(acceleration.size, 1 / rate_hz)
    low, high = VELOCITY_BAND_HZ
    band = (frequency >= low) & (frequency <= high)
    return float(np.sqrt(2 * np.sum(np.abs(lines[band] / (2 * np.pi * frequency[band])) ** 2)))


def _checked(limits: Limits, channels: Sequence[str]) -> Limits:
    for channel, entry in limits.items():
        if channel not in channels:
            raise UserError(f"limits: no channel {channel!r}; {nearest(str(channel), list(channels))}")
        what = f"limits of {channel} = {entry!r:.80}"
        if not isinstance(entry, Sequence) or len(entry) != len(ZONES):
            raise UserError(f"{what}: give a quantity and three limits, of the zones A, B and C")
        if entry[0] not in QUANTITIES:
            raise UserError(f"{what}: no quantity {entry[0]!r}; {nearest(str(entry[0]), list(QUANTITIES))}")
        if not all(isinstance(each, float | int) for each in entry[1:]) or not all(
            0 < a < b for a, b in pairwise(entry[1:])
        ):
            raise UserError(f"{what}: the limits must be numbers above 0 that rise")
    return limits


def _zone(row: Mapping[str, object], limits: Limits) -> str | None:
    """Return the zone of one row: A up to the first limit, D above the last; None without limits or value."""
    if row["channel"] not in limits:
        return None
    quantity, *bounds = limits[str(row["channel"])]
    value = row[quantity]
    if not isinstance(value, float) or np.isnan(value):
        return None
    return ZONES[int(np.searchsorted(bounds, value))]
