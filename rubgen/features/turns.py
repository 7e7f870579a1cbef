"""Follow the turns of the shaft by its recorded pulses: order tracking."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from math import prod
from operator import mul

import numpy as np
from scipy.sparse import csr_array

from rubgen.arrays import ComplexArray, FloatArray

LEAST_POINTS = 64
"""The fewest points in a turn."""
NEAR = np.arange(-2.0, 4.0)
"""Samples about a place that a value there is interpolated from."""

EDGE = 1e-6
"""Samples by which a pulse may lie outside the first and the last sample: subtracted times have rounding errors."""

BLOCK = 2048
"""Places whose weights are computed together: their arrays stay in the processor's cache."""


def by_turn(signals: FloatArray, rate_hz: float, pulses: FloatArray) -> FloatArray:
    """Resample signals (channels, samples) at equal angles, as (channels, turns, points a turn).

    - rate_hz: samples a second.
    - pulses: times of the pulses in s from the first sample. Only whole turns between two pulses are used.

    The angle is linear in time between two pulses. Values between samples come from Lagrange's polynomial through the
    six nearest samples: the error of an amplitude is below 1 % up to a sixth of the sample rate. A turn has as many
    points as the longest turn has samples, at least LEAST_POINTS. Without two pulses there are no turns.
    """
    count, samples = signals.shape
    inside = within(pulses, samples, rate_hz)
    turns = max(inside.size - 1, 0)
    points = max(LEAST_POINTS, int(np.ceil(np.diff(inside).max() * rate_hz)) if turns else 0)
    at = np.interp(np.arange(turns * points) / points, np.arange(max(turns, 1) + 1), inside if turns else (0, 0))
    matrix = _weights(at * rate_hz, samples)
    turned = np.empty((count, turns * points))
    for row, signal in enumerate(signals):  # one after the other: a signal stays in the processor's cache
        turned[row] = matrix @ signal
    return turned.reshape(count, turns, points)


def within(pulses: FloatArray, samples: int, rate_hz: float) -> FloatArray:
    """Return the pulses (any,) in s that lie between the first and the last of `samples` samples, both included.

    Times count from the first sample. `rate_hz` is the sample rate.
    """
    places = pulses * rate_hz
    return pulses[(places >= -EDGE) & (places <= samples - 1 + EDGE)]


def circles(turned: FloatArray | ComplexArray, orders: Sequence[int], turns: int = 1) -> ComplexArray:
    """Compute the complex amplitudes at `orders` / `turns` of the speed of each signal, as (orders, signals).

    - turned (signals, turns, points a turn): from `by_turn`, real or complex.
    - orders: whole numbers; negative orders turn backward.
    - turns: number of turns of one period. Only whole periods are used; without one the amplitudes are NaN.

    A real signal A cos(k theta - phi) has (A / 2) exp(-i phi) at order k, with theta from the first pulse.
    """
    count, whole, points = len(turned), turned.shape[1] // turns * turns, turned.shape[2]
    if not whole:
        return np.full((len(orders), count), np.nan + 0j)
    mean = turned[:, :whole].reshape(count, -1, turns * points).mean(axis=1)
    angle = -2j * np.pi * np.arange(turns * points) / (turns * points)
    return np.asarray([mean @ np.exp(order * angle) / (turns * points) for order in orders])


def _weights(places: FloatArray, samples: int) -> csr_array:
    """Return the matrix (places, samples) that interpolates samples at places (any,) counted in samples."""
    first = np.clip(np.floor(places) + NEAR[0], 0, max(samples - NEAR.size, 0))
    offset, weights = places - first, np.empty((places.size, NEAR.size))
    for begin in range(0, places.size, BLOCK):
        block = slice(begin, begin + BLOCK)
        away = [offset[block] - other for other in range(NEAR.size)]
        before, after = [*accumulate(away[:-1], mul, initial=1.0)], [*accumulate(away[:0:-1], mul, initial=1.0)][::-1]
        for own in range(NEAR.size):
            weights[block, own] = (
                before[own] * after[own] / prod(own - other for other in range(NEAR.size) if other != own)
            )
    columns = first[:, None].astype(np.int32) + np.arange(NEAR.size, dtype=np.int32)
    starts = np.arange(0, columns.size + 1, NEAR.size, dtype=np.int32)
    return csr_array((weights.ravel(), columns.ravel(), starts), shape=(places.size, samples))
