"""Whether the amplitudes of orders fit a recorded channel, as far as it resolves them."""

import math
from collections.abc import Iterator

import numpy as np

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.dataset.checking.impulse_check import Row
from rubgen.labels.harmonics import SPECTRUM_TURNS
from rubgen.measurement.chain import PASS_BAND_SHARE
from rubgen.measurement.channel import Float32Array

COMPARED_ORDERS = 10
"""At most: those within the anti-alias filter's pass band."""
NOISE_PEAK = 6.5
"""Gaussian noise of 1e6 samples stays below 6.5 times its rms."""
ORDER_TOLERANCE = 0.01
"""Of the largest amplitude."""


def order_problems(row: Row, tap: str, values: Float32Array, noise_rms: float, step: float) -> Iterator[str]:
    """What contradicts between the orders of a true signal and the channel (samples,) of it, at a steady speed.

    Silent where fewer turns are recorded than the label has.
    """
    turns = min(SPECTRUM_TURNS, row["record_turns"])
    turns_per_sample = row["speed_rpm"] / 60 / row["sample_rate_hz"]
    samples = round(turns / turns_per_sample)
    if values.size < samples:
        return
    amplitudes = order_amplitudes(values[-samples:], turns_per_sample)
    labels = np.asarray(row[f"{tap}_orders"][:COMPARED_ORDERS])
    passed = np.arange(1, COMPARED_ORDERS + 1) * turns_per_sample <= PASS_BAND_SHARE / 2
    error = np.abs(amplitudes - labels) - ORDER_TOLERANCE * labels.max() - _spectral_floor(noise_rms, step, samples)
    error[~passed] = 0
    if error.max() > 0:  # rare
        error -= _of_unseen_end(row, values, samples, turns_per_sample)
    if error.max() > 0:
        k = int(error.argmax())
        yield f"{tap}_orders: order {k + 1} is {labels[k]:.4g}, the channel gives {amplitudes[k]:.4g}"


def order_amplitudes(values: Float32Array, turns_per_sample: float) -> FloatArray:
    """Peak amplitudes at k = 1..10 times the rotation frequency: 2/n |sum x exp(-2 pi i k turns)|, mean removed."""
    return np.asarray(2 / values.size * np.abs(_turned(values, turns_per_sample).sum(axis=1)))


def _turned(values: Float32Array, turns_per_sample: float) -> ComplexArray:
    """Samples times exp(-2 pi i k turns) for k = 1..10 (orders, samples), mean removed."""
    turns = np.arange(values.size) * turns_per_sample
    centred = values.astype(np.float64) - values.mean(dtype=np.float64)
    return np.asarray([np.exp(-2j * np.pi * k * turns) * centred for k in range(1, COMPARED_ORDERS + 1)])


def _of_unseen_end(row: Row, values: Float32Array, samples: int, turns_per_sample: float) -> FloatArray:
    """How far each amplitude may differ because the channel ends before the label's window does, by half a filter.

    The label has d samples at its end that the channel has not, and lacks d that the channel has at its beginning. Both
    pieces together change an amplitude by at most twice that of the largest piece: as large as the largest of all
    pieces of the recording, for any motion. One more sample stands for the whole number that is no whole turn.
    """
    end = row["record_turns"] / turns_per_sample
    last = row["signal_start_s"] * row["sample_rate_hz"] + values.size - 1
    piece = min(math.ceil(max(end - last, 0.0)) + 1, values.size)
    sums = np.cumsum(np.pad(_turned(values, turns_per_sample), ((0, 0), (1, 0))), axis=1)
    return np.asarray(2 * 2 / samples * np.abs(sums[:, piece:] - sums[:, :-piece]).max(axis=1))


def _spectral_floor(noise_rms: float, step: float, samples: int) -> float:
    """Largest amplitude that noise and ADC steps put into a line: white where the noise dithers the steps."""
    if noise_rms < step / 2:
        return step
    return NOISE_PEAK * math.sqrt((noise_rms**2 + step**2 / 12) * 2 / samples)
