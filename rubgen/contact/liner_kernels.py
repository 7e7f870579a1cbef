"""The worn depth of an abradable liner over the polar angle: a periodic cubic spline whose coefficients only grow."""

import math
from typing import NamedTuple

from rubgen.arrays import FloatArray
from rubgen.jit import allocation_free_kernel, inlined_kernel

REMOVED, WORK = range(2)


class Liner(NamedTuple):
    """The constants of an abradable liner on the casing."""

    bins: int
    """Number of coefficients of the worn depth; 0 where there is no liner."""
    thickness: float
    """The largest worn depth, m."""
    rate: float
    """Volume worn for each unit of force times sliding, m2/N."""
    area: float
    """Worn volume for each metre of a coefficient, m2."""


class Wear(NamedTuple):
    """The state of a liner: worn depth and sums. `remove` changes the arrays."""

    depth: FloatArray
    """Coefficients (bins,) of the worn depth, 0 to `Liner.thickness`, m."""
    earlier: FloatArray
    """The same (2, bins) two steps and one step before."""
    sums: FloatArray
    """Sums so far (2,): REMOVED volume, m3; WORK of the contact force on the receding surface, J."""


@inlined_kernel
def spline_weights(s: float) -> tuple[float, float, float, float]:
    """Return the weights of four neighbouring coefficients of a uniform cubic B-spline. They add up to 1.

    The point lies between the second and the third coefficient, at the share s, 0 to 1, of their distance.
    """
    r = 1 - s
    return r * r * r / 6, (4 - 6 * s * s + 3 * s * s * s) / 6, (4 - 6 * r * r + 3 * r * r * r) / 6, s * s * s / 6


@allocation_free_kernel
def worn_depth(coefficients: FloatArray, psi: float) -> tuple[float, float, float]:
    """Return the worn depth at the polar angle psi (rad) in m, and its first and second derivative by the angle.

    `coefficients` (bins,) are the coefficients of the periodic spline, m, such as `Wear.depth`.
    """
    bins = coefficients.shape[0]
    per_angle = bins / (2 * math.pi)
    position = psi * per_angle
    first = math.floor(position)
    s = position - first
    a, b = coefficients[int((first - 1) % bins)], coefficients[int(first % bins)]
    c, d = coefficients[int((first + 1) % bins)], coefficients[int((first + 2) % bins)]
    w = spline_weights(s)
    r = 1 - s
    slope = 0.5 * (s * s * (d - c) + r * r * (b - a)) + (0.5 + s * r) * (c - b)
    bend = r * (a - 2 * b + c) + s * (b - 2 * c + d)
    return w[0] * a + w[1] * b + w[2] * c + w[3] * d, per_angle * slope, per_angle * per_angle * bend


@allocation_free_kernel
def remove(liner: Liner, psi: float, volume: float, wear: Wear) -> None:
    """Remove a volume (m3, >= 0) from the liner around the polar angle `psi` (rad). Changes `wear`.

    The four splines at `psi` take shares of the volume by their weights, which add up to 1. A share increases the
    spline's coefficient by share / `liner.area`. A coefficient stops at the liner's thickness, and the rest of its
    share is not removed. The removed volume is added to `wear.sums`.
    """
    bins = liner.bins
    position = psi * (bins / (2 * math.pi))
    first = math.floor(position)
    weights = spline_weights(position - first)
    for i in range(4):
        bin_ = int((first - 1 + i) % bins)
        grown = min(weights[i] * volume / liner.area, liner.thickness - wear.depth[bin_])
        wear.depth[bin_] += grown
        wear.sums[REMOVED] += grown * liner.area
