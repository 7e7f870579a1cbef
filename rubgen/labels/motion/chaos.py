"""The 0-1 test on the parts of a Poincare section."""

import numpy as np
from scipy.linalg import eigh

from rubgen.arrays import FloatArray
from rubgen.labels.motion.clusters import rms, without_periodic_part
from rubgen.labels.motion.zero_one_test import growth_correlation

CHAOTIC_FROM = 0.7
"""K of the 0-1 test from which a motion is chaotic. Chaotic maps of exponent > 0.1 have 0.8 to 1 on 500 points."""
ROUNDING = 1e-6
"""Distances below this share of the part's motion may be rounding or the rest of a transient."""
OBSERVABLES = 3
"""Largest number of principal components in the 0-1 test. Each must have 1 % of the leading one's variance."""


def chaos_indicator(points: FloatArray) -> float:
    """Largest K of the groups of points (turns, groups, values).

    For a blisk the first group is the disk centre, the others are the tips.

    Each K is the median of the 0-1 test over the leading principal components of the points without their periodic
    part. Where the first half of the record is more than twice as far from the clusters as the second half, the motion
    is still settling, and only the second half is tested. A group whose distance is below ROUNDING has K = 0.
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
    """The leading principal components (1 .. OBSERVABLES, turns) of the section, each without its mean.

    Components below 1 % of the leading one's variance are left out: they may be rounding.
    """
    flat = points.reshape(points.shape[0], -1)
    flat = flat - flat.mean(axis=0)
    width = flat.shape[1]
    variances, axes = eigh(flat.T @ flat, subset_by_index=(max(0, width - OBSERVABLES), width - 1))
    count = int(np.sum(variances >= 0.01 * variances[-1]))
    return np.asarray((flat @ axes[:, ::-1][:, :count]).T, dtype=np.float64)
