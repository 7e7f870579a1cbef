"""Minimum and maximum of a signal in equal bins: a preview that keeps every spike."""

from __future__ import annotations

import numpy as np

from rubgen.sensors.channel import Float32Array

PREVIEW_RATE_HZ = 1024.0


def preview_bin(sample_rate_hz: float) -> int:
    """Samples a bin so that a preview has about 1024 bins a second, one at least."""
    return max(1, round(sample_rate_hz / PREVIEW_RATE_HZ))


def min_max(values: Float32Array, samples_per_bin: int) -> tuple[Float32Array, Float32Array]:
    """Minima and maxima of `values` (n,) in bins of `samples_per_bin`, each (ceil(n / samples_per_bin),).

    The last bin may hold fewer samples. An empty signal gives empty arrays.
    """
    if values.size == 0:
        return values.copy(), values.copy()
    starts = np.arange(0, values.size, samples_per_bin)
    return np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
