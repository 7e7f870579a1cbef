"""Features of a recorded signal: common ones of condition monitoring, and amplitudes at orders of the speed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from rubgen.arrays import FloatArray

OF_SIGNAL: dict[str, Callable[[FloatArray], Any]] = {
    "rms": lambda x: np.sqrt(np.mean(x**2)),
    "maximum": np.max,
    "minimum": np.min,
    "peak_to_peak": np.ptp,
    "interquartile_range": lambda x: np.subtract(*np.percentile(x, (75, 25))),
    "mean_absolute": lambda x: np.mean(np.abs(x)),
    "median_absolute": lambda x: np.median(np.abs(x)),
    "99th_percentile": lambda x: np.percentile(np.abs(x), 99),
    "kurtosis": lambda x: np.mean(x**4) / np.mean(x**2) ** 2,
    "skewness": lambda x: np.mean(x**3) / np.mean(x**2) ** 1.5,
    "crest_factor": lambda x: np.abs(x).max() / np.sqrt(np.mean(x**2)),
    "impulse_factor": lambda x: np.abs(x).max() / np.mean(np.abs(x)),
    "shape_factor": lambda x: np.sqrt(np.mean(x**2)) / np.mean(np.abs(x)),
    "clearance_factor": lambda x: np.abs(x).max() / np.mean(np.sqrt(np.abs(x))) ** 2,
    "histogram_entropy": lambda x: _entropy(np.histogram(x, bins=64)[0].astype(np.float64)),
    "mean_absolute_difference": lambda x: np.mean(np.abs(np.diff(x))),
    "median_absolute_difference": lambda x: np.median(np.abs(np.diff(x))),
    "zero_crossings": lambda x: np.mean(x[1:] * x[:-1] < 0),
    "turning_points": lambda x: np.mean(np.diff(x)[1:] * np.diff(x)[:-1] < 0),
    "autocorrelation_1": lambda x: np.mean(x[1:] * x[:-1]) / np.mean(x**2),
}
"""Of a signal (samples,) without its mean."""
OF_SPECTRUM: dict[str, Callable[[FloatArray, FloatArray], Any]] = {
    "strongest_frequency": lambda f, p: f[np.argmax(p)],
    "strongest_share": lambda _, p: p.max() / p.sum(),
    "spectral_centroid": lambda f, p: _moment(f, p, 1),
    "spectral_spread": lambda f, p: np.sqrt(_central(f, p, 2)),
    "spectral_skewness": lambda f, p: _central(f, p, 3) / _central(f, p, 2) ** 1.5,
    "spectral_kurtosis": lambda f, p: _central(f, p, 4) / _central(f, p, 2) ** 2,
    "spectral_entropy": lambda _, p: _entropy(p),
    "spectral_flatness": lambda _, p: np.exp(np.mean(np.log(p + 1e-30))) / np.mean(p),
    "5th_percentile_frequency": lambda f, p: _roll(f, p, 0.05),
    "median_frequency": lambda f, p: _roll(f, p, 0.5),
    "85th_percentile_frequency": lambda f, p: _roll(f, p, 0.85),
    "95th_percentile_frequency": lambda f, p: _roll(f, p, 0.95),
    "below_1_khz": lambda f, p: p[f < 1e3].sum(),
    "1_to_4_khz": lambda f, p: p[(f >= 1e3) & (f < 4e3)].sum(),
    "above_4_khz": lambda f, p: p[f >= 4e3].sum(),
}
"""Of the frequencies (bins,) in Hz and the power of each (bins,)."""
ORDERS = (1, 2, 3, 4, 6, 8)
"""Orders of the speed whose amplitude is a feature, beside the number of blades."""
NAMES = (*OF_SIGNAL, *OF_SPECTRUM, *(f"order_{order}" for order in ORDERS), "order_blades")
"""Names of all features: those of `common`, then those of `orders`."""


def common(signal: FloatArray, sample_rate_hz: float) -> FloatArray:
    """The common features (35,) of a signal (samples,); 0 where one is not finite, as of a constant signal."""
    x = signal - signal.mean()
    window = np.hanning(x.size)
    power = np.asarray(np.abs(np.fft.rfft(x * window)) ** 2 / np.sum(window**2) / x.size * 2, dtype=np.float64)
    frequency = np.asarray(np.fft.rfftfreq(x.size, 1 / sample_rate_hz), dtype=np.float64)
    with np.errstate(all="ignore"):
        found = [float(of(x)) for of in OF_SIGNAL.values()]
        found += [float(of(frequency, power)) for of in OF_SPECTRUM.values()]
    return np.asarray(np.nan_to_num(np.array(found), nan=0.0, posinf=0.0, neginf=0.0))


def orders(signal: FloatArray, angle: FloatArray, blades: int) -> FloatArray:
    """Amplitudes (7,) of the signal (samples,) at the orders and at the number of blades.

    - angle: of the shaft at the samples (samples,), rad, from the recorded pulses.
    """
    whole = angle - angle[0] <= 2 * np.pi * np.floor((angle[-1] - angle[0]) / (2 * np.pi))
    x, theta = signal[whole] - signal[whole].mean(), angle[whole]
    return np.array([2 * abs(np.mean(x * np.exp(-1j * order * theta))) for order in (*ORDERS, blades)])


def angle_from(pulses: Sequence[float] | FloatArray, times: FloatArray) -> FloatArray:
    """The angle of the shaft in rad at times (n,) in s, linear between the once-per-turn pulses and beyond them."""
    at = np.asarray(pulses, dtype=np.float64)
    if at.size < 2:
        raise ValueError(f"{at.size} pulses give no angle; two or more do")
    turns = np.interp(times, at, np.arange(at.size))
    rate = 1 / np.diff(at)
    turns = np.where(times < at[0], (times - at[0]) * rate[0], turns)
    turns = np.where(times > at[-1], at.size - 1 + (times - at[-1]) * rate[-1], turns)
    return np.asarray(2 * np.pi * turns)


def _entropy(weights: Any) -> float:
    """Entropy of shares that are proportional to the weights, over the largest possible."""
    share = weights[weights > 0] / weights.sum()
    return float(-np.sum(share * np.log(share)) / np.log(weights.size))


def _moment(values: FloatArray, weights: FloatArray, power: int) -> float:
    return float(np.sum(values**power * weights) / weights.sum())


def _central(values: FloatArray, weights: FloatArray, power: int) -> float:
    return _moment(values - _moment(values, weights, 1), weights, power)


def _roll(frequency: FloatArray, power: FloatArray, share: float) -> float:
    """The frequency below which that share of the power lies."""
    total = np.cumsum(power)
    return float(frequency[np.searchsorted(total, share * total[-1])])
