"""Test whether the points of a Poincare section repeat after some turns."""

import math

import numpy as np

from rubgen.arrays import FloatArray

LONGEST_PERIOD = 16
CLUSTER_RADIUS = 0.01
"""Largest rms distance of points from the mean of their cluster: 1 % (-40 dB) of the part's motion."""
EXCURSION = 0.03
"""Largest distance of a single point."""


def late_distances(points: FloatArray) -> list[FloatArray]:
    """Return the distances of points (turns, groups, values) from k = 1, 2, ... clusters, each (late turns,).

    The points must already be divided by the size of the motion, as those of `blisk_points` and `casing_points`
    are. Only the second half of the record is used, where transients have decayed. k is at most 16, in a short record
    at most an eighth of the turns, of which there must be at least eight. See `cluster_distances`.
    """
    late = points[points.shape[0] // 2 :]
    return [cluster_distances(late, k) for k in range(1, min(LONGEST_PERIOD, len(late) // 4) + 1)]


def cluster_period(distances: list[FloatArray]) -> int | None:
    """Return the smallest k <= 16 after which points repeat, or None. `distances` are from `late_distances`.

    A point's distance to the mean of its cluster is the distance of its farthest group, so that one chattering tip
    counts. The distances must be at most CLUSTER_RADIUS (rms over turns) and at most EXCURSION in each turn. Their rms
    must not more than double from the first half of these turns to the second, unless it stays below a tenth of
    CLUSTER_RADIUS.
    """
    for period, distance in enumerate(distances, start=1):
        if rms(distance) <= CLUSTER_RADIUS and distance.max() <= EXCURSION and not _grows(distance):
            return period
    return None


def stray(distances: list[FloatArray], period: int | None) -> float:
    """Return the rms distance of points from their k clusters. `distances` are from `late_distances`.

    k is `period` in turns, or for None the k with the smallest result. The result is a share of the size of the motion,
    because `late_distances` is given points that are divided by it. The means of k clusters of n points lie nearer to
    the points than the true means: dividing the mean square by 1 - k / n corrects this.
    """
    periods = range(1, len(distances) + 1) if period is None else (period,)
    return min(rms(distances[k - 1]) / math.sqrt(1 - k / distances[k - 1].size) for k in periods)


def cluster_distances(points: FloatArray, period: int) -> FloatArray:
    """Return the distance (turns,) of each point (turns, groups, values) to the mean of its cluster.

    It is the distance of the farthest group. A cluster consists of every `period`-th point.
    """
    return farthest(off_cluster(points, period))


def farthest(points: FloatArray) -> FloatArray:
    """Return the largest norm of the groups of each of the points (turns, groups, values), as (turns,)."""
    squares = points * points
    # Few values a group: column by column, as a sum of fewer than eight goes anyway, but over whole arrays.
    if 0 < points.shape[2] < 8:
        total = squares[..., 0]
        for value in range(1, points.shape[2]):
            total = total + squares[..., value]
    else:
        total = squares.sum(axis=2)
    return np.asarray(np.sqrt(total.max(axis=1)), dtype=np.float64)


def without_periodic_part(points: FloatArray) -> FloatArray:
    """Subtract from the points (turns, groups, values) the means of their k clusters, and return the rest.

    k is the number with the least remaining variance, at most 16 and an eighth of the turns. There must be at least
    eight turns. Without this, a motion that wanders within bands and visits the bands in turn would look regular,
    because the bands are larger. The variance is divided by turns - k, so that more clusters alone do not reduce it.
    """
    turns = points.shape[0]
    kept, least = points, math.inf
    for k in range(1, min(LONGEST_PERIOD, turns // 8) + 1):
        rest = off_cluster(points, k)
        variance = float(np.vdot(rest, rest)) / (turns - k)
        if variance < least:
            kept, least = rest, variance
    return kept


def off_cluster(points: FloatArray, period: int) -> FloatArray:
    """Subtract from each point the mean of its cluster, and return the rest. A cluster is every `period`-th point."""
    turns = len(points)
    whole = turns - turns % period
    # Summed turn after turn, as a mean of every period-th point would be: the same bits.
    total = points[:whole].reshape(-1, period, *points.shape[1:]).sum(axis=0)
    total[: turns - whole] += points[whole:]
    count = np.full(period, turns // period)
    count[: turns - whole] += 1
    mean = total / count.reshape(period, *(1,) * (points.ndim - 1))
    residual = np.empty_like(points)
    np.subtract(points[:whole].reshape(-1, *mean.shape), mean, out=residual[:whole].reshape(-1, *mean.shape))
    np.subtract(points[whole:], mean[: turns - whole], out=residual[whole:])
    return residual


def settles(distances: list[FloatArray]) -> bool:
    """Return whether points still approach a steady motion. `distances` are from `late_distances`.

    In the second half of the record, the rms distance from the clusters then falls by more than half from the first
    quarter to the last, from above CLUSTER_RADIUS. The number of clusters is the k with the smallest distance.
    """
    corrected = [each / math.sqrt(1 - k / each.size) for k, each in enumerate(distances, start=1)]
    first, *_, last = (rms(quarter) for quarter in np.array_split(min(corrected, key=rms), 4))
    return first > 2 * last and first > CLUSTER_RADIUS


def rms(values: FloatArray) -> float:
    """Return the root of the mean square of values."""
    return float(np.sqrt(np.mean(values**2)))


def _grows(distance: FloatArray) -> bool:
    """Whether the later half is more than twice as far as the earlier half and above rounding: an orbit being left."""
    half = distance.size // 2
    earlier, later = rms(distance[:half]), rms(distance[half:])
    return later > 2 * earlier and later > CLUSTER_RADIUS / 10
