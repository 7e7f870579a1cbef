"""Order spectra of recorded channels along a run: from samples in time to amplitudes over orders of rotation."""

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.measurement.channel import Float32Array

BLOCK_TURNS = 16
SAMPLES_PER_TURN = 256
HIGHEST_ORDER = 12


@dataclass(frozen=True, kw_only=True)
class OrderMap:
    """Peak amplitudes (blocks, orders) in the channel's unit at `order` (orders,); block i begins at `time[i]` in s."""

    time: FloatArray
    order: FloatArray
    amplitude: FloatArray


def order_map(
    values: Float32Array, sample_rate_hz: float, pulses: FloatArray, *, turns: int = BLOCK_TURNS, most_blocks: int = 60
) -> OrderMap:
    """Spectra of a channel over blocks of `turns` turns (fewer in a shorter recording), at most `most_blocks`.

    `pulses` (any,) are the times in s at which turns begin. The samples are read by linear interpolation at 256 equal
    angles of each turn, so that orders stay sharp while the speed changes; |2 X / n| under no window, for each block
    holds whole turns. Blocks with lost samples are left out, and without two pulses there is none. Valid up to order
    12 while the sample rate is some 50 times the rotation frequency.
    """
    length = min(turns, pulses.size - 1)
    if length < 1:
        return OrderMap(time=np.zeros(0), order=np.zeros(0), amplitude=np.zeros((0, 0)))
    share = np.arange(SAMPLES_PER_TURN) / SAMPLES_PER_TURN
    at = (pulses[:-1, None] + share * np.diff(pulses)[:, None]).ravel()
    angular = np.interp(at, np.arange(values.size) / sample_rate_hz, values)
    count = (pulses.size - 1) // length
    blocks = angular[: count * length * SAMPLES_PER_TURN].reshape(count, -1)
    chosen = np.flatnonzero(np.isfinite(blocks).all(axis=1))
    chosen = chosen[:: max(1, -(-chosen.size // most_blocks))]
    blocks = blocks[chosen]
    stop = HIGHEST_ORDER * length + 1
    return OrderMap(
        time=pulses[chosen * length],
        order=np.arange(1, stop) / length,
        amplitude=np.asarray(2 / blocks.shape[1] * np.abs(np.fft.rfft(blocks, axis=1)[:, 1:stop])),
    )
