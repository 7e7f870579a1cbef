"""The 0-1 test on the parts of a section."""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from rubgen.arrays import FloatArray
from rubgen.labels.motion.clusters import rms, without_periodic_part
from rubgen.labels.motion.zero_one_test import growth_correlation

CHAOTIC_FROM = 0.7
"""K of the 0-1 test from which a motion is chaotic: chaotic maps of exponent > 0.1 give 0.8 to 1 on 500 points."""
ROUNDING = 1e-6
"""What strays by less than this share of the part's motion may be rounding or the rest of a transient."""
OBSERVABLES = 3
"""Most principal components that the 0-1 test looks at; each must hold 1 % of the leading one's variance."""


def chaos_indicator(points: FloatArray) -> float:
    """Largest K of the first group of the points and of the others: for a blisk, of the disk centre and of the tips.

    Each is the median K of the 0-1 test over the leading principal components of those points without their periodic
    part. Where the first half of the record strays more than twice as far as the second, it is still settling, and the
    second alone is tested. A group that strays by less than ROUNDING has K = 0.
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
