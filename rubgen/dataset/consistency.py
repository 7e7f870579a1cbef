"""Whether labels, parameters and recorded signals of a run fit each other."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from rubgen.labels.harmonics import HIGHEST_ORDER, SPECTRUM_TURNS
from rubgen.labels.labels import Motion
from rubgen.sensors.channel import Float32Array
from rubgen.sensors.probes import PROBES, Probe

Row = dict[str, Any]
REGULARITY = [motion.value for motion in Motion]
NOISE_PEAK = 6.5
"""Gaussian noise of 1e6 samples stays below 6.5 times its rms."""
ORDER_TOLERANCE = {True: 0.01, False: 0.1}
"""Of the largest amplitude, for a motion that repeats and one that does not: the channel ends half a filter length
before the label's window. In 23 runs of the default recipe nothing and 0.016 went beyond the noise."""
FORCE_TOLERANCE = 0.01
"""For period-1 motion; seen: 0.0003."""
SHARE_TOLERANCE = 1e-9
PULSE_TOLERANCE = 1e-9
ENERGY_TOLERANCE = 1e-8


def label_problems(row: Row) -> Iterator[str]:
    """What contradicts itself in the labels of a valid run."""
    rules = {
        "contact_duty outside [0, 1]": 0 <= row["contact_duty"] <= 1,
        "rub and contact_duty": row["rub"] == (row["contact_duty"] > 0),
        "rub and contact_impulse_per_turn_n_s": row["rub"] == (row["contact_impulse_per_turn_n_s"] > 0),
        "rub and blades_touched": row["rub"] == (row["blades_touched"] > 0),
        "rub and contact_zones": row["rub"] == (row["contact_zones"] > 0),
        "contact_zones and its centres": row["contact_zones"] == len(row["contact_zone_centres_rad"]),
        "contact_zones and its widths": row["contact_zones"] == len(row["contact_zone_widths_rad"]),
        "has_2fr without rub": row["rub"] or not row["has_2fr"],
        "motion is not the less regular of the two": _rank(row["motion"])
        == max(_rank(row["motion_blisk"]), _rank(row["motion_casing"])),
        "energy_residual": row["energy_residual"] <= ENERGY_TOLERANCE,
    }
    rules |= {f"{which} and its period": _period_fits(row, which) for which in ("", "_blisk", "_casing")}
    rules["period is not the least common multiple"] = _common_period(row)
    for probe in PROBES:
        rules[f"shares or dominant order of {probe.tap}"] = _shares_fit(row, probe.tap)
    yield from (name for name, holds in rules.items() if not holds)


def signal_problems(row: Row, signals: dict[str, Float32Array], noise: float, adc_bits: int) -> Iterator[str]:
    """What contradicts itself between the labels of a valid run and its channels.

    `noise` and `adc_bits` are the recipe's. Channels that reached their range are left out of the comparison.
    """
    lengths = {values.size for values in signals.values()}
    if len(lengths) != 1:
        yield f"channels of different lengths {sorted(lengths)}"
    for probe in PROBES:
        values = signals[probe.name]
        if not np.isfinite(values).all():
            yield f"{probe.name} is not finite"
        elif _within_range(values, probe):
            yield from _probe_problems(row, probe, values, noise, adc_bits)
    yield from _pulse_problems(row, signals["once_per_rev"])


def _probe_problems(row: Row, probe: Probe, values: Float32Array, noise: float, adc_bits: int) -> Iterator[str]:
    step = (probe.range_max - probe.range_min) / 2**adc_bits
    if probe.name == "contact_force" and not row["rub"]:
        limit = NOISE_PEAK * noise * probe.noise_rms + step
        if np.abs(values).max() > limit:
            yield f"rub is false, but contact_force reaches {np.abs(values).max():.4g} N (noise allows {limit:.4g})"
    if probe.name == "contact_force" and row["motion"] == Motion.PERIOD_1.value and row["rub"]:
        yield from _force_problems(row, values)
    yield from _order_problems(row, probe, values, noise * probe.noise_rms, step)


def _force_problems(row: Row, force: Float32Array) -> Iterator[str]:
    impulse = float(force.astype(np.float64).mean()) * 60 / row["speed_rpm"]
    label = row["contact_impulse_per_turn_n_s"]
    if abs(impulse - label) > FORCE_TOLERANCE * label + 1e-3:
        yield f"contact_impulse_per_turn_n_s is {label:.4g}, the channel gives {impulse:.4g}"


def _order_problems(row: Row, probe: Probe, values: Float32Array, noise_rms: float, step: float) -> Iterator[str]:
    samples = round(min(SPECTRUM_TURNS, row["record_turns"]) * row["sample_rate_hz"] * 60 / row["speed_rpm"])
    if values.size < samples:
        return
    amplitudes = order_amplitudes(values[-samples:], row["speed_rpm"] / 60 / row["sample_rate_hz"])
    labels = np.asarray(row[f"{probe.tap}_orders"])
    error = np.abs(amplitudes - labels)
    if error.max() > ORDER_TOLERANCE[row["period"] is not None] * labels.max() + _spectral_floor(
        noise_rms, step, samples
    ):
        k = int(error.argmax())
        yield f"{probe.tap}_orders: order {k + 1} is {labels[k]:.4g}, the channel gives {amplitudes[k]:.4g}"


def _spectral_floor(noise_rms: float, step: float, samples: int) -> float:
    """Largest amplitude that noise and ADC steps put into a line: white where the noise dithers the steps."""
    if noise_rms < step / 2:
        return step
    return NOISE_PEAK * math.sqrt((noise_rms**2 + step**2 / 12) * 2 / samples)


def order_amplitudes(values: Float32Array, turns_per_sample: float) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Peak amplitudes at k = 1..10 times the rotation frequency: 2/n |sum x exp(-2 pi i k turns)|, mean removed."""
    turns = np.arange(values.size) * turns_per_sample
    centred = values.astype(np.float64) - values.mean(dtype=np.float64)
    sums = [np.exp(-2j * np.pi * k * turns) @ centred for k in range(1, HIGHEST_ORDER + 1)]
    return np.asarray(2 / values.size * np.abs(sums))


def _pulse_problems(row: Row, pulses: Float32Array) -> Iterator[str]:
    times = np.asarray(row["once_per_rev_s"])
    turn = 60 / row["speed_rpm"]
    if not np.allclose(np.diff(times), turn, rtol=0, atol=PULSE_TOLERANCE * max(1.0, turn)):
        yield "once_per_rev_s is not spaced by one turn"
    rises = int(np.count_nonzero((pulses[1:] > 0) & (pulses[:-1] == 0)))
    if abs(rises - times.size) > 1:
        yield f"once_per_rev has {rises} pulses, once_per_rev_s has {times.size}"


def _within_range(values: Float32Array, probe: Probe) -> bool:
    margin = (probe.range_max - probe.range_min) * 1e-3
    low = probe.range_min + margin if probe.range_min < 0 else -math.inf
    return bool(values.min() > low and values.max() < probe.range_max - margin)


def _rank(motion: str) -> int:
    return REGULARITY.index(motion)


def _period_fits(row: Row, which: str) -> bool:
    motion, period = row[f"motion{which}"], row[f"period{which}"]
    if motion == Motion.PERIOD_1.value:
        return bool(period == 1)
    if motion == Motion.PERIOD_K.value:
        return period is not None and period > 1
    return period is None


def _common_period(row: Row) -> bool:
    if row["motion"] not in (Motion.PERIOD_1.value, Motion.PERIOD_K.value):
        return row["period"] is None
    return bool(row["period"] == math.lcm(row["period_blisk"] or 1, row["period_casing"] or 1))


def _shares_fit(row: Row, tap: str) -> bool:
    orders = np.asarray(row[f"{tap}_orders"])
    even, odd = row[f"{tap}_even_share"], row[f"{tap}_odd_share"]
    if not orders.any():
        return even is None and odd is None and row[f"{tap}_dominant_order"] == 0
    total = math.nan if even is None or odd is None else even + odd
    return bool(abs(total - 1) < SHARE_TOLERANCE and row[f"{tap}_dominant_order"] == int(orders.argmax()) + 1)
