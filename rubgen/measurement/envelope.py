"""Minimum and maximum of signals in equal bins: a preview that keeps every spike."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray, IntArray
from rubgen.measurement.channel import Channel, Float32Array

PREVIEW_RATE_HZ = 1024.0


@dataclass(frozen=True, kw_only=True)
class Preview:
    """Channels in equal bins: `values` (bins, columns) in their unit, bin i from sample `first[i]` on.

    Each channel has two columns, `<channel>.min` and `<channel>.max`, as `names` says.
    """

    names: tuple[str, ...]
    first: IntArray
    values: FloatArray


def preview(channels: Sequence[Channel], sample_rate_hz: float, rate_hz: float = PREVIEW_RATE_HZ) -> Preview:
    """Minimum and maximum of channels (one at least) of the same length in about `rate_hz` bins a second."""
    samples_per_bin = max(1, round(sample_rate_hz / rate_hz))
    ends = [end for channel in channels for end in min_max(channel.values, samples_per_bin)]
    return Preview(
        names=tuple(f"{channel.name}.{end}" for channel in channels for end in ("min", "max")),
        first=np.arange(0, channels[0].values.size, samples_per_bin),
        values=np.column_stack(ends).astype(np.float64),
    )


def min_max(values: Float32Array, samples_per_bin: int) -> tuple[Float32Array, Float32Array]:
    """Minima and maxima of `values` (n,) in bins of `samples_per_bin`, each (ceil(n / samples_per_bin),).

    The last bin may hold fewer samples. An empty signal gives empty arrays.
    """
    if values.size == 0:
        return values.copy(), values.copy()
    starts = np.arange(0, values.size, samples_per_bin)
    return np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
