"""Compiled loop of the sample-rate conversion."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from rubgen.jit import kernel

Array = npt.NDArray[np.float64]


ABREAST = 4
"""Channels that are summed side by side in registers."""


@kernel
def interpolate_rows(signals: Array, bank: Array, positions: Array, out: Array) -> None:
    """Filter `signals` (steps, channels) at fractional step `positions` (samples,) into `out` (samples, channels).

    Row m of `bank` (phases + 1, 2 half) holds the weights for a position m / phases beyond a step; between two rows
    they are interpolated linearly. Tap j belongs to step floor(position) - half + 1 + j; every such step must exist.
    The number of channels must be a multiple of ABREAST.
    """
    phases = bank.shape[0] - 1
    taps = bank.shape[1]
    weights = np.empty(taps)
    for i in range(positions.shape[0]):
        step = int(np.floor(positions[i]))
        phase = (positions[i] - step) * phases
        row = min(int(phase), phases - 1)
        share = phase - row
        first = step - taps // 2 + 1
        for j in range(taps):
            weights[j] = (1.0 - share) * bank[row, j] + share * bank[row + 1, j]
        for c in range(0, signals.shape[1], ABREAST):
            sum_0 = sum_1 = sum_2 = sum_3 = 0.0
            for j in range(taps):
                weight = weights[j]
                sum_0 += weight * signals[first + j, c]
                sum_1 += weight * signals[first + j, c + 1]
                sum_2 += weight * signals[first + j, c + 2]
                sum_3 += weight * signals[first + j, c + 3]
            out[i, c], out[i, c + 1], out[i, c + 2], out[i, c + 3] = sum_0, sum_1, sum_2, sum_3
