"""Test whether the points of a Poincare section repeat after some turns."""

import math

import numpy as np

from rubgen.arrays import FloatArray

LONGEST_PERIOD = 16
CLUSTER_RADIUS = 0.01
"""Largest rms distance of points from the mean of their cluster: 1 % (-40 dB) of the part's motion."""
EXCURSION = 0.03
"""Largest distance of a single point."""


def cluster_period(points: FloatArray) -> int | None:
    """Return the smallest k <= 16 after which the points (turns, groups, values) repeat, or None.

    Only the second half of the record is used, where transients have decayed. A point's distance to the mean of its
    cluster is the distance of its farthest group, so that one chattering tip counts. The distances must be at most
    CLUSTER_RADIUS (rms over turns) and at most EXCURSION in each turn, and must not grow. In a short record k is at
    most an eighth of the turns.
    """
    late = _late(points)
    for period in range(1, _longest(late) + 1):
        distance = cluster_distances(late, period)
        if rms(distance) <= CLUSTER_RADIUS and distance.max() <= EXCURSION and not _grows(distance):
            return period
    return None


def stray(points: FloatArray, period: int | None) -> float:
    """Return the rms distance of the points of the record's second half from their k clusters.

    k is `period`. For None it is the k with the smallest distance among all k that `cluster_period` tries. `points`
    (turns, groups, values), at least eight turns, are divided by the size of the motion. The means of k clusters of n
    points lie nearer to the points than the true means: dividing the mean square by 1 - k / n corrects this.
    """
    late = _late(points)
    periods = range(1, _longest(late) + 1) if period is None else (period,)
    return min(rms(cluster_distances(late, k)) / math.sqrt(1 - k / len(late)) for k in periods)


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
    left = [off_cluster(points, k) for k in range(1, min(LONGEST_PERIOD, turns // 8) + 1)]
    variance = [np.sum(rest**2) / (turns - k) for k, rest in enumerate(left, start=1)]
    return left[int(np.argmin(variance))]


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


def settles(points: FloatArray) -> bool:
    """Return whether the points (turns, groups, values), at least eight turns, still approach a steady motion.

    In the second half of the record, the rms distance from the clusters then falls by more than half from the first
    quarter to the last, from above CLUSTER_RADIUS. The number of clusters is the k with the smallest distance among all
    k that `cluster_period` tries.
    """
    late = _late(points)
    distances = [cluster_distances(late, k) / math.sqrt(1 - k / len(late)) for k in range(1, _longest(late) + 1)]
    first, *_, last = (rms(quarter) for quarter in np.array_split(min(distances, key=rms), 4))
    return first > 2 * last and first > CLUSTER_RADIUS


def rms(values: FloatArray) -> float:
    """Return the root of the mean square of values."""
    return float(np.sqrt(np.mean(values**2)))


def _late(points: FloatArray) -> FloatArray:
    return points[points.shape[0] // 2 :]


def _longest(late: FloatArray) -> int:
    return min(LONGEST_PERIOD, len(late) // 4)


def _grows(distance: FloatArray) -> bool:
    """Whether the later half is more than twice as far as the earlier half and above rounding: an orbit being left."""
    half = distance.size // 2
    earlier, later = rms(distance[:half]), rms(distance[half:])
    return later > 2 * earlier and later > CLUSTER_RADIUS / 10
