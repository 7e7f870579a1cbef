"""Features of a signal over time, from its samples alone."""

from __future__ import annotations

import numpy as np

from rubgen.arrays import FloatArray

ROUNDING = 1e-12
"""A signal whose rms is below this share of its mean is constant."""


def time_features(signals: FloatArray) -> FloatArray:
    """Compute the features `vocabulary.TIME` of signals (channels, samples), as (channels, features).

    A ratio of a constant signal is NaN.
    """
    mean = signals.mean(axis=1, keepdims=True)
    x = signals - mean
    square, size = x * x, np.abs(x)
    rms = np.sqrt(square.mean(axis=1))
    scale = np.where(rms > ROUNDING * np.abs(mean[:, 0]), rms, np.nan)
    peak, typical = size.max(axis=1), np.where(np.isnan(scale), np.nan, size.mean(axis=1))
    skewness, kurtosis = (square * x).mean(axis=1) / scale**3, (square * square).mean(axis=1) / scale**4
    ratios = [skewness, kurtosis, peak / scale, scale / typical, peak / typical]
    return np.column_stack([mean[:, 0], rms, peak, np.ptp(signals, axis=1), *ratios])
