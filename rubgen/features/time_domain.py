"""Features of a signal over time, from its samples alone."""

from __future__ import annotations

import numpy as np

from rubgen.arrays import FloatArray

ROUNDING = 1e-12
"""A signal whose rms is below this share of its mean is constant."""


def time_features(signals: FloatArray) -> FloatArray:
    """Compute the features `vocabulary.TIME` of signals (channels, samples), as (channels, features).

    Ratios are NaN for a constant signal.
    """
    return np.array([_of_one(signal) for signal in signals])  # one after the other: it stays in the processor's cache


def _of_one(signal: FloatArray) -> list[float]:
    mean = float(signal.mean())
    x = signal - mean
    square, size = x * x, np.abs(x)
    rms = float(np.sqrt(square.mean()))
    scale = rms if rms > ROUNDING * abs(mean) else np.nan
    peak, typical = float(size.max()), float(size.mean()) if scale > 0 else np.nan
    skewness, kurtosis = float(square @ x) / x.size / scale**3, float(square @ square) / x.size / scale**4
    return [
        mean, rms, peak, float(np.ptp(signal)), skewness, kurtosis, peak / scale, scale / typical, peak / typical
    ]  # fmt: skip
