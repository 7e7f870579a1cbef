"""Name every feature, with its unit and its definition. The page docs/features.md is made from these tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

SETS = ("time", "order", "envelope", "orbit")
"""The sets of features that rubgen computes itself, in the order of their columns."""
GENERIC = "tsfel"
"""The set that the package tsfel computes."""
NEED_PULSES = ("order", "envelope", "orbit")
"""The sets that need the pulse of a once-per-turn sensor."""
ORDERS = tuple(range(1, 13))
"""Whole orders of the speed."""
FRACTIONS = {"1_3": (1, 3), "1_2": (1, 2), "2_3": (2, 3)}
"""Fractional orders by their name, as numerator and denominator."""
BANDS_HZ = ((500, 2000), (2000, 5000), (5000, 10000))
"""Bands of the envelope. A data set has those up to its sample rate / 2.56, where its channels are flat."""
ENVELOPE_ORDERS = (1, 2, 3, 4)
SIDES = ("1_2", "1", "2", "3")
"""Orders of the full spectrum of an orbit, by their name."""
HIGH = "above 3.3 times its median and a quarter of its maximum"
SAME = "as the channel"


@dataclass(frozen=True)
class Feature:
    """One feature: a column is called `<channel>__<name>`."""

    name: str
    unit: str
    """SAME for the unit of the channel."""
    meaning: str


TIME = (
    Feature("mean", SAME, "mean"),
    Feature("rms", SAME, "root mean square of the signal without its mean"),
    Feature("peak", SAME, "largest distance from the mean"),
    Feature("peak_to_peak", SAME, "largest minus smallest value"),
    Feature("skewness", "1", "third central moment over rms^3"),
    Feature("kurtosis", "1", "fourth central moment over rms^4; 3 for a normal distribution, 1.5 for a sine"),
    Feature("crest_factor", "1", "peak over rms; sqrt(2) for a sine"),
    Feature("shape_factor", "1", "rms over the mean distance from the mean; pi / sqrt(8) for a sine"),
    Feature("impulse_factor", "1", "peak over the mean distance from the mean; pi / 2 for a sine"),
)
ORDER = (
    Feature("turns", "1", "whole turns of the window that the features of this set come from"),
    *(Feature(f"order_{k}", SAME, f"amplitude at {k} times the speed") for k in ORDERS),
    *(
        Feature(f"order_{name}", SAME, f"amplitude at {p}/{q} of the speed; null below {q} turns")
        for name, (p, q) in FRACTIONS.items()
    ),
    Feature("order_1_phase", "deg", "phase lag at the speed: angle from the pulse to the maximum, 0 to 360"),
    Feature("synchronous_rms", SAME, "rms of the mean turn, without its mean: what repeats each turn"),
    Feature("not_synchronous_rms", SAME, "rms of the signal minus the mean turn; null below 2 turns"),
    Feature("not_1x_rms", SAME, "rms without the mean and without order 1"),
)
ORBIT = (
    Feature("orbit_major", SAME, "larger half axis of the ellipse at order 1"),
    Feature("orbit_minor", SAME, "smaller half axis; > 0 for forward whirl, < 0 for backward whirl"),
    Feature("orbit_angle", "deg", "angle of the larger half axis from X towards Y, 0 to 180"),
    Feature("s_max", SAME, "largest distance of the shaft from its mean place"),
    *(
        Feature(
            f"{side}_{name}",
            SAME,
            f"full spectrum: amplitude of the {side} circle at order {name.replace('_', '/')}",
        )
        for name in SIDES
        for side in ("forward", "backward")
    ),
)


def envelope(sample_rate_hz: float) -> tuple[Feature, ...]:
    """Return the features of the envelope, for each band that is possible at this sample rate."""
    return tuple(feature for low, high in bands(sample_rate_hz) for feature in _in_band(low, high))


def bands(sample_rate_hz: float) -> tuple[tuple[int, int], ...]:
    """Return the envelope's bands, in Hz, that end at or below the sample rate / 2.56."""
    return tuple(band for band in BANDS_HZ if band[1] <= sample_rate_hz / 2.56)


def of_channel(sets: Sequence[str], sample_rate_hz: float) -> tuple[Feature, ...]:
    """Return the features of one channel in these sets, in the order of the columns."""
    tables = {"time": TIME, "order": ORDER, "envelope": envelope(sample_rate_hz)}
    return tuple(feature for name in SETS if name in sets for feature in tables.get(name, ()))


def _in_band(low: int, high: int) -> tuple[Feature, ...]:
    start, band = f"envelope_{low}_{high}_hz", f"the envelope of the band {low:,} to {high:,} Hz"
    return (
        Feature(f"{start}_mean", SAME, f"mean of {band}"),
        Feature(f"{start}_rms", SAME, f"rms of {band} without its mean"),
        Feature(f"{start}_peak", SAME, f"maximum of {band}"),
        Feature(f"{start}_kurtosis", "1", f"kurtosis of {band}"),
        *(Feature(f"{start}_order_{k}", SAME, f"amplitude of {band} at order {k}") for k in ENVELOPE_ORDERS),
        Feature(f"{start}_impacts_per_turn", "1/turn", f"maxima of {band} in a turn, {HIGH}"),
    )
