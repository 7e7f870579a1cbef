"""The right-hand side of `bench_rk45` compiled with numba, blade by blade."""

from __future__ import annotations

import math
from typing import NamedTuple

import numba
import numpy as np

from rubgen.arrays import FloatArray


class Penalty(NamedTuple):
    """Constants of one system; n coordinates, m blades, c casing modes, k nodes."""

    rates: FloatArray  # (n, 2n), [-M^-1 K, -M^-1 C]
    constant: FloatArray  # (n,), M^-1 f
    columns: FloatArray  # (n, n), the columns of M^-1, one a row
    radial: FloatArray  # (k, c), radial displacements of the nodes
    around: FloatArray  # (k, c), circumferential ones
    tip_static: FloatArray  # (m, 3), m
    blade_angles: FloatArray  # (m,), rad
    curve: FloatArray  # (orders, 3), amplitude in m, order, phase in rad
    numbers: FloatArray  # tip radius, mean radius of the surface, spin speed, friction, penalty


@numba.njit
def slope_of(model: Penalty, t: float, y: FloatArray, slope: FloatArray) -> None:
    """Set `slope` (2n + 1,) to y' of y = [q, q', impulse]."""
    n, c, nodes = len(model.constant), model.radial.shape[1], len(model.radial)
    radius, mean, omega, friction, penalty = model.numbers
    slope[:n] = y[n : 2 * n]
    slope[n : 2 * n] = model.constant + np.dot(model.rates, y[: 2 * n])
    slope[2 * n] = 0.0
    for blade in range(len(model.tip_static)):
        r = radius + y[3 * blade] + model.tip_static[blade, 0]
        v = y[3 * blade + 1] + model.tip_static[blade, 1]
        angle = omega * t + model.blade_angles[blade] + math.atan2(v, r)
        depth = math.hypot(r, v) - mean
        for amplitude, order, phase in model.curve:
            depth -= amplitude * math.cos(order * (angle - phase))
        at = (angle % (2 * math.pi)) * nodes / (2 * math.pi)
        below, share = int(at) % nodes, at % 1.0
        above = (below + 1) % nodes
        for mode in range(c):
            shape = (1 - share) * model.radial[below, mode] + share * model.radial[above, mode]
            depth -= shape * y[n - c + mode]
        if depth <= 0:
            continue
        normal = penalty * depth
        slope[2 * n] += normal
        slope[n : 2 * n] -= normal * (model.columns[3 * blade] + friction * model.columns[3 * blade + 1])
        for mode in range(c):
            radial = (1 - share) * model.radial[below, mode] + share * model.radial[above, mode]
            around = (1 - share) * model.around[below, mode] + share * model.around[above, mode]
            slope[n : 2 * n] += normal * (radial + friction * around) * model.columns[n - c + mode]
