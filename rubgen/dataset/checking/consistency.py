"""Checks that labels, parameters and recorded signals of a run agree."""

import dataclasses
import math
from collections.abc import Iterator
from functools import lru_cache

import numpy as np

from rubgen.dataset.checking.channel_check import (
    NOISE_PEAK,
    Row,
    duty_fits,
    exponents_fit,
    impulse_problems,
    order_problems,
    window_times_fit,
    windows_fit,
)
from rubgen.labels.contact.amounts import RubExtent
from rubgen.labels.harmonics import FLOOR, MARKED_TAP, RATIO
from rubgen.labels.labels import Motion
from rubgen.measurement.channel import Float32Array
from rubgen.measurement.shaft import NOTCH_ANGLE
from rubgen.measurement.surroundings import DISTURBED_TAPS
from rubgen.scenario import Sensing
from rubgen.sensors.kinds.once_per_rev import OncePerRev
from rubgen.sensors.kinds.proximity import Proximity
from rubgen.sensors.sensor import SampledSensor
from rubgen.taps import HousingAcceleration

REGULARITY = [motion.value for motion in Motion]
SHARE_TOLERANCE = 1e-9
PULSE_TOLERANCE = 1e-9
IMPULSE_TOLERANCE = 1e-5
"""Touches are stored in single precision."""
ENERGY_TOLERANCE = 1e-8


def label_problems(row: Row) -> Iterator[str]:
    """Yield the contradictions among the labels of a run with status ok, such as contact time without a rub.

    `row` has the run's columns of `runs.parquet`, classes as words.
    """
    rules = {
        "contact_duty outside [0, 1]": 0 <= row["contact_duty"] <= 1,
        "rub and contact_duty": row["rub"] == (row["contact_duty"] > 0),
        "rub and contact_impulse_per_turn_n_s": row["rub"] == (row["contact_impulse_per_turn_n_s"] > 0),
        "rub and blades_touched": row["rub"] == (row["blades_touched"] > 0),
        "rub and contact_zones": row["rub"] == (row["contact_zones"] > 0),
        "contact_zones and its centres": row["contact_zones"] == len(row["contact_zone_centres_rad"]),
        "contact_zones and its widths": row["contact_zones"] == len(row["contact_zone_widths_rad"]),
        "rub and rub_extent": row["rub"] == (row["rub_extent"] != RubExtent.NONE.value),
        "contact_touches and blade_touches": row["contact_touches"] == sum(row["blade_touches"]),
        "blades_touched and blade_touches": row["blades_touched"] == sum(count > 0 for count in row["blade_touches"]),
        "blade_impulses_per_turn_n_s and contact_impulse_per_turn_n_s": math.isclose(
            sum(row["blade_impulses_per_turn_n_s"]),
            row["contact_impulse_per_turn_n_s"],
            rel_tol=IMPULSE_TOLERANCE,
            abs_tol=IMPULSE_TOLERANCE,
        ),
        "contact_impulse_per_turn_n_s and its windows": windows_fit(row),
        "contact_duty and its windows": duty_fits(row),
        "windows and speed_rpm": window_times_fit(row),
        "lyapunov_per_second and lyapunov_per_turn": exponents_fit(row),
        "has_2fr without rub": row["rub"] or not row["has_2fr"],
        "motion is not the less regular of the two": _rank(row["motion"])
        == max(_rank(row["motion_blisk"]), _rank(row["motion_casing"])),
        "has_2fr and orders_present": row["has_2fr"] == (2 in row["orders_present"]),
        "energy_residual": row["energy_residual"] <= ENERGY_TOLERANCE,
    }
    rules |= {f"{which} and its period": _period_fits(row, which) for which in ("", "_blisk", "_casing")}
    rules["period is not the least common multiple"] = _common_period(row)
    rules["orders_present and the orders of casing_acc_0"] = _present_fit(row)
    for tap in (name.removesuffix("_orders") for name in row if name.endswith("_orders")):
        rules[f"shares or dominant order of {tap}"] = _shares_fit(row, tap)
    yield from (name for name, holds in rules.items() if not holds)


def signal_problems(row: Row, signals: dict[str, Float32Array], sensing: Sensing) -> Iterator[str]:
    """Yield the contradictions between the labels of a run with status ok and its channels.

    - row: the run's parameters and labels, by column, classes as words.
    - signals: its channels, by name.
    - sensing: the sensors of the run and how they are recorded.

    All channels must be finite and of one length. Pulses are compared with `once_per_rev_s`. A channel is compared with
    labels only if its values stay within its range, its sensor has no error but noise and ADC, and the sensor feels no
    surroundings.
    """
    lengths = {values.size for values in signals.values()}
    if len(lengths) > 1:
        yield f"channels of different lengths {sorted(lengths)}"
    for sensor in sensing.set.sensors:
        if isinstance(sensor, OncePerRev):
            yield from _pulse_problems(row, sensor, signals[sensor.name])
        if isinstance(sensor, SampledSensor):
            values = signals[sensor.name]
            if not np.isfinite(values).all():
                yield f"{sensor.name} is not finite"
            elif _shows_the_motion(sensor, sensing, row) and _within_range(values, *sensor.full_range):
                yield from _sensor_problems(row, sensor, values, sensing)


def is_faultless(sensor: SampledSensor, sensing: Sensing) -> bool:
    """Return whether a sensor records the truth in SI units, except for noise, range and ADC."""
    disturbed = isinstance(sensor, Proximity) and bool(sensing.set.shaft_runout)
    return not disturbed and _has_no_error(sensor)


@lru_cache(maxsize=256)  # every run of a set has the same sensors
def _has_no_error(sensor: SampledSensor) -> bool:
    usual = dataclasses.asdict(dataclasses.replace(sensor, range=None, noise_rms=0.0, adc_bits=None))
    plain = {field.name: field.default for field in dataclasses.fields(SampledSensor) if field.name in usual}
    differs = [key for key, value in plain.items() if key not in ("name", "unit") and usual[key] != value]
    return not differs and sensor.UNITS[sensor.unit] == 1.0


def _shows_the_motion(sensor: SampledSensor, sensing: Sensing, row: Row) -> bool:
    """Return whether a sensor measures the true motion, apart from noise: no error and no surroundings disturb it.

    The housing's motion has no labels to compare.
    """
    if isinstance(sensor.tap, HousingAcceleration):
        return False
    surrounded = "background_m_per_s2" in row and isinstance(sensor.tap, DISTURBED_TAPS)
    return not surrounded and is_faultless(sensor, sensing)


def _sensor_problems(row: Row, sensor: SampledSensor, values: Float32Array, sensing: Sensing) -> Iterator[str]:
    low, high = sensor.full_range
    step = (high - low) / 2 ** (sensor.adc_bits or sensing.adc_bits)
    noise_rms, tap = sensing.noise * sensor.noise_rms, sensor.tap.name
    if tap == "contact_force" and not row["rub"]:
        limit = NOISE_PEAK * noise_rms + step
        if np.abs(values).max() > limit:
            yield f"rub is false, but {sensor.name} reaches {np.abs(values).max():.4g} N (noise allows {limit:.4g})"
    repeats = row["motion"] == Motion.PERIOD_1.value and not row["change_times_s"]
    if tap == "contact_force" and repeats and row["rub"]:
        yield from impulse_problems(row, values, noise_rms, step)
    if not row["change_times_s"]:  # of a changing speed
        yield from order_problems(row, tap, values, noise_rms, step)


def _pulse_problems(row: Row, sensor: OncePerRev, pulses: Float32Array) -> Iterator[str]:
    times = np.asarray(row["once_per_rev_s"])
    turn = 60 / row["speed_rpm"]
    exact = sensor.jitter_s == 0 and sensor.clock_hz == 0 and not row["change_times_s"]
    if exact and not np.allclose(np.diff(times), turn, rtol=0, atol=PULSE_TOLERANCE * max(1.0, turn)):
        yield "once_per_rev_s is not spaced by one turn"
    rises = int(np.count_nonzero((pulses[1:] > 0) & (pulses[:-1] == 0)))
    shortest = np.diff(times).min(initial=turn)
    shows_each = shortest * row["sample_rate_hz"] * NOTCH_ANGLE / (2 * np.pi) >= 1
    if shows_each and abs(rises - times.size) > 1:
        yield f"{sensor.name} has {rises} pulses, once_per_rev_s has {times.size}"


def _within_range(values: Float32Array, low: float, high: float) -> bool:
    margin = (high - low) * 1e-3
    least = low + margin if low < 0 else -math.inf
    return bool(values.min() > least and values.max() < high - margin)


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


def _present_fit(row: Row) -> bool:
    orders, floors = (np.asarray(row[f"{MARKED_TAP}_{kind}"]) for kind in ("orders", "order_floors"))
    stands = np.flatnonzero((orders > FLOOR) & (orders >= RATIO * floors)) + 1
    return bool(row["orders_present"] == (stands.tolist() if row["rub"] else []))


def _shares_fit(row: Row, tap: str) -> bool:
    orders = np.asarray(row[f"{tap}_orders"], dtype=np.float64)  # NaN above half the step rate
    even, odd, dominant = (row[f"{tap}_{name}"] for name in ("even_share", "odd_share", "dominant_order"))
    moves = bool(np.nansum(orders**2) > 0)
    if dominant != (int(np.nanargmax(orders)) + 1 if moves else 0):
        return False
    if not moves or np.isnan(orders).any():
        return even is None and odd is None
    return even is not None and odd is not None and bool(abs(even + odd - 1) < SHARE_TOLERANCE)
