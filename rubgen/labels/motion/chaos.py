"""Apply the 0-1 test for chaos to the parts of a Poincare section."""

from functools import lru_cache

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.linalg import eigh

from rubgen.arrays import FloatArray
from rubgen.labels.motion.clusters import rms, without_periodic_part

CHAOTIC_FROM = 0.7
"""K of the 0-1 test from which a motion is chaotic. Chaotic maps of exponent > 0.1 have 0.8 to 1 on 500 points."""
ROUNDING = 1e-6
"""Distances below this share of the part's motion may be rounding or the rest of a transient."""
OBSERVABLES = 3
"""Largest number of principal components in the 0-1 test. Each must have 1 % of the leading one's variance."""
FREQUENCIES = np.pi * (0.2 + 0.6 * (np.arange(100) + 0.5) / 100 + 0.002 * np.sin(1.0 + np.arange(100) ** 2))
"""100 fixed c in (pi/5, 4 pi/5): evenly spread, then shifted a little so that no c is a simple fraction of pi."""
DAMPING = 2.5
"""Gottwald and Melbourne's alpha."""
DAMPED_FROM = 200
"""Least number of points for the damped variant: with fewer, n is too short to average out the added oscillation."""


def chaos_indicator(points: FloatArray) -> float:
    """Return the larger K of the 0-1 test of group 0 of the points (turns, groups, values) and of all others together.

    K is near 1 for chaos. There must be at least 32 turns. Group 0 of a blisk is the disk centre, the others are the
    tips; a casing has group 0 alone. The points must already be divided by the size of the motion, as those of
    `blisk_points` and `casing_points` are. Each K is the median of the 0-1 test over the leading principal components
    of the points without their periodic part. If the first half of the record is more than twice as far from the
    clusters as the second half, the motion still settles, and only the second half is tested. K is 0 for a group whose
    distance from its clusters is below ROUNDING.
    """
    half = points.shape[0] // 2
    first, second = (rms(without_periodic_part(part)) for part in (points[:half], points[half:]))
    steady = points[half:] if first > 2 * second else points
    return max(_group_indicator(group) for group in (steady[:, :1], steady[:, 1:]) if group.size)


def _group_indicator(points: FloatArray) -> float:
    rest = without_periodic_part(points)
    if rms(np.linalg.norm(rest, axis=(1, 2))) < ROUNDING:
        return 0.0
    return float(np.median([growth_correlation(observable) for observable in principal_components(rest)]))


def principal_components(points: FloatArray) -> FloatArray:
    """Return the leading principal components (1 .. OBSERVABLES, turns) of the section `points`, each without its mean.

    Components with less than 1 % of the largest variance are left out: they may be rounding.
    """
    flat = points.reshape(points.shape[0], -1)
    flat = flat - flat.mean(axis=0)
    width = flat.shape[1]
    variances, axes = eigh(flat.T @ flat, subset_by_index=(max(0, width - OBSERVABLES), width - 1))
    count = int(np.sum(variances >= 0.01 * variances[-1]))
    return np.asarray((flat @ axes[:, ::-1][:, :count]).T, dtype=np.float64)


def growth_correlation(observable: FloatArray) -> float:
    """Compute K of the 0-1 test for a scalar observable (N,): near 1 for chaos, near 0 for regular motion.

    The observable has N >= 32 points of a Poincare section. It is the test of Gottwald and Melbourne. The translation
    is p_c(n) = sum_{j <= n} phi_j exp(i c j). Its mean square displacement is M_c(n) = mean_j |p_c(j + n) - p_c(j)|^2
    over n = 1 .. N/10. Without its oscillation it is D_c(n) = M_c(n) - mean(phi)^2 (1 - cos n c)/(1 - cos c). The
    damped variant is D*_c(n) = D_c(n) + DAMPING var(phi) sin(sqrt(2) n): its oscillation is far larger than the slow
    growth that a little noise adds to regular motion. K_c = corr(n, D*_c(n)), and K is the median of K_c over all c.
    Below DAMPED_FROM points D_c takes the place of D*_c. The authors scale the oscillation by mean(phi)^2, which
    depends on the zero of the observable; var(phi) does not. Not valid for a constant with rounding noise: test for
    clusters first.
    """
    displacement = mean_square_displacement(observable)
    size, cut = observable.size, displacement.shape[1]
    steps = np.arange(1, cut + 1)
    oscillation = observable.mean() ** 2 * _oscillation(cut)
    alpha = DAMPING if size >= DAMPED_FROM else 0.0
    damping = alpha * observable.var() * np.sin(np.sqrt(2) * steps)
    return float(np.median(_correlation(steps.astype(np.float64), displacement - oscillation + damping)))


def mean_square_displacement(observable: FloatArray) -> FloatArray:
    """Return M_c(n) (frequencies, n_cut) of an observable (N,), every mean over the same L = N - n_cut starts.

    p_c(j + n) - p_c(j) is a sum of n points, and its square is a sum over their pairs. Pairs d points apart have the
    factor cos(c d), the only one that depends on c: L M_c(n) = T_0(n) + 2 sum_{0 < d < n} cos(c d) T_d(n), with T_d(n)
    = sum_{j < L} sum_{d < b <= n} phi_{j + b - d} phi_{j + b}.
    """
    size = observable.size
    cut = max(size // 10, 3)
    starts = size - cut
    before = sliding_window_view(np.concatenate([np.zeros(cut - 1), observable]), size)[::-1]
    sums = np.cumsum(observable * before, axis=1)
    pairs = np.triu(sums[:, starts:] - sums[:, :cut])
    return np.asarray(_pair_factors(cut) @ np.cumsum(pairs, axis=1) / starts, dtype=np.float64)


@lru_cache(maxsize=4)
def _pair_factors(cut: int) -> FloatArray:
    """Return the factors (frequencies, cut) of pairs d < cut points apart: 1 for d = 0, else 2 cos(c d)."""
    factors = 2 * np.cos(FREQUENCIES[:, None] * np.arange(cut))
    factors[:, 0] = 1.0
    factors.setflags(write=False)
    return np.asarray(factors)


@lru_cache(maxsize=4)
def _oscillation(cut: int) -> FloatArray:
    """Return (1 - cos n c) / (1 - cos c) (frequencies, cut) for n = 1 .. cut."""
    c = FREQUENCIES[:, None]
    shape = (1 - np.cos(np.arange(1, cut + 1) * c)) / (1 - np.cos(c))
    shape.setflags(write=False)
    return np.asarray(shape)


def _correlation(steps: FloatArray, curves: FloatArray) -> FloatArray:
    """Return the Pearson correlation of each row of `curves` with `steps`; 0 for a constant row."""
    s = steps - steps.mean()
    d = curves - curves.mean(axis=1, keepdims=True)
    norm = np.linalg.norm(d, axis=1) * np.linalg.norm(s)
    return np.asarray(d @ s / np.where(norm > 0, norm, 1.0), dtype=np.float64)
