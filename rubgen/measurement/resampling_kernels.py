"""The compiled loop of the sample-rate conversion."""

import numpy as np
import numpy.typing as npt

from rubgen.jit import kernel
from rubgen.linalg.lanes_kernels import COUNT, FIRST, KIND, ROW, add_lines
from rubgen.linalg.vector_kernels import LANES

Array = npt.NDArray[np.float64]

ABREAST = 2 * LANES
"""Channels that are summed side by side in two vector registers, always so many: a sum's order hangs on their number,
and a channel's bits must not hang on how many others there are."""


@kernel
def interpolate_rows(signals: Array, bank: Array, positions: Array, out: Array) -> None:
    """Filter `signals` (steps, channels) at fractional step `positions` (samples,) into `out` (samples, channels).

    Row m of `bank` (phases + 1, 2 half) contains the weights for a position m / phases after a step. Weights between
    two rows are interpolated linearly. Weight j belongs to step floor(position) - half + 1 + j; every such step must
    exist. There must be ABREAST channels, and `out` must contain zeros.
    """
    phases = bank.shape[0] - 1
    taps = bank.shape[1]
    rows = ABREAST // LANES
    weights = np.empty(taps)
    line = np.zeros((1, 5), dtype=np.int64)
    line[0, KIND], line[0, COUNT] = 2 * rows - 1, taps  # line_kind(rows, scaled=True)
    for i in range(positions.shape[0]):
        step = int(np.floor(positions[i]))
        phase = (positions[i] - step) * phases
        row = min(int(phase), phases - 1)
        share = phase - row
        for j in range(taps):
            weights[j] = (1.0 - share) * bank[row, j] + share * bank[row + 1, j]
        line[0, ROW], line[0, FIRST] = i * rows, (step - taps // 2 + 1) * rows
        add_lines(line, signals, weights, out)
