"""Orders of rotation of one turn, over its angle."""

from __future__ import annotations

import numpy as np

from rubgen.arrays import ComplexArray, FloatArray

ORDERS = 20


def turn_orders(taps: FloatArray, theta: FloatArray) -> ComplexArray:
    """Complex amplitudes (taps, 20) at k = 1 .. 20 of `taps` (taps, steps), the steps at angles `theta` (steps + 1,).

    2 / (2 pi) sum x exp(-i k theta) dtheta by the trapezoidal rule on the steps' own angles, taken from the first to
    the last as if they were one turn: the ends miss it by half a step at most, which leaves a share of 1 / steps.
    """
    weight = np.zeros(taps.shape[1])
    weight += 0.5 * np.diff(theta)
    weight[1:] += 0.5 * np.diff(theta)[:-1]
    weight[0] += 0.5 * (theta[-1] - theta[-2])
    wave = np.exp(-1j * np.multiply.outer(theta[:-1], np.arange(1, ORDERS + 1)))
    return np.asarray(2 / weight.sum() * ((taps - taps.mean(axis=1, keepdims=True)) @ (weight[:, None] * wave)))
