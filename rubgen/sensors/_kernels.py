"""Compiled loop of the sample-rate conversion."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from rubgen.jit import kernel

Array = npt.NDArray[np.float64]


@kernel
def interpolate_rows(signals: Array, bank: Array, positions: Array, out: Array) -> None:
    """Filter `signals` (steps, channels) at fractional step `positions` (samples,) into `out` (samples, channels).

    Row m of `bank` (phases + 1, 2 half) holds the weights for a position m / phases beyond a step; between two rows
    they are interpolated linearly. Tap j belongs to step floor(position) - half + 1 + j; every such step must exist.
    """
    phases = bank.shape[0] - 1
    taps = bank.shape[1]
    channels = signals.shape[1]
    for i in range(positions.shape[0]):
        step = int(np.floor(positions[i]))
        phase = (positions[i] - step) * phases
        row = min(int(phase), phases - 1)
        share = phase - row
        first = step - taps // 2 + 1
        for c in range(channels):
            out[i, c] = 0.0
        for j in range(taps):
            weight = (1.0 - share) * bank[row, j] + share * bank[row + 1, j]
            for c in range(channels):
                out[i, c] += weight * signals[first + j, c]
