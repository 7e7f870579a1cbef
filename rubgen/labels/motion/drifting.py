"""Classify the motion of a stretch of a record while its speed or its machine changes slowly.

While a parameter drifts slowly, a periodic motion follows its steady one: the points of its Poincare section move along
smooth branches, one a turn of its period. The points of a chaotic motion scatter, and earlier points do not tell the
next one.
"""

from dataclasses import replace

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.labels.labels import Motion
from rubgen.labels.motion.chaos import principal_components
from rubgen.labels.motion.classify import Motions
from rubgen.labels.motion.clusters import CLUSTER_RADIUS, EXCURSION, farthest
from rubgen.labels.motion.decision import AT_REST, FORCED, MotionClass, combined
from rubgen.labels.motion.section import blisk_points, casing_points, casing_rests
from rubgen.solver.response import Response

BRANCH_TURNS = 32
"""Turns about the middle of a stretch on which its branches are fitted."""
DEGREE = 2
"""Degree of the polynomial in time of each coordinate of a branch."""
MOST_BRANCHES = 4
"""Longest period: more branches would have more coefficients than half the turns."""
SCATTER = 0.05
"""Least rms distance from the branches of a chaotic motion, over the motion: five times the radius of a cluster."""
PREDICTED_TURNS = 64
"""Turns about the middle of a stretch on which points are predicted."""
EARLIER = 6
"""Number of earlier points from which a point is predicted."""
UNPREDICTABLE = 0.7
"""Least error of a prediction, over the standard deviation, of a chaotic motion.

On 64 points it is at most 0.45 for a sinusoid with second and third order whose frequency changes by 0.3 rad a turn. It
is at least 0.77 for the logistic map and Henon's map."""
UNDECIDED = MotionClass(motion=Motion.UNDECIDED, period=None, confidence=0.0)


def drifting_motion(response: Response, first: int, last: int, *, rub: bool) -> Motions:
    """Return the classes of motion of the turns first .. last - 1 of a record, whose speed or machine may drift.

    `rub` is whether blades touch in these turns. Without a rub the motion is the forced motion, if this is known
    (`Response.knows_free_motion`); while the casing still moves, casing and system are undecided. Otherwise, on
    BRANCH_TURNS about the middle, which may reach beyond a short stretch:

    - periodic after k <= 4 turns where the points lie on k branches, within CLUSTER_RADIUS rms and EXCURSION each. A
      branch is every kth point, fitted by a quadratic in time; the rms is corrected for its coefficients.
    - chaotic where the part does not repeat, and a group of any part (disk centre, tips, casing) lies farther than
      SCATTER from one branch and cannot be predicted (`prediction_error`) over PREDICTED_TURNS: contact couples the
      parts.
    - undecided otherwise: on a torus, while the motion settles, across a change. A class needs a record of 32 turns,
      chaos of 64.

    A beat that takes more than some hundred turns counts as drift.
    """
    if not rub and response.knows_free_motion:
        rests = casing_rests(cut(response, first, last))
        return Motions(blisk=FORCED, casing=AT_REST if rests else UNDECIDED, system=FORCED if rests else UNDECIDED)
    near = _about(response, first, last, BRANCH_TURNS)
    if near.record_turns < BRANCH_TURNS:
        return Motions(blisk=UNDECIDED, casing=UNDECIDED, system=UNDECIDED)
    far = _about(response, first, last, PREDICTED_TURNS)
    rests = casing_rests(near)
    parts = [blisk_points(near)] if rests else [blisk_points(near), casing_points(near)]
    wide = [blisk_points(far)] if rests else [blisk_points(far), casing_points(far)]
    chaotic = far.record_turns == PREDICTED_TURNS and any(
        _scatters(group, around)
        for part, outer in zip(parts, wide, strict=True)
        for group, around in zip(_groups(part), _groups(outer), strict=True)
    )
    classes = [*(_class_of(part, chaotic=chaotic) for part in parts), AT_REST][:2]
    return Motions(blisk=classes[0], casing=classes[1], system=combined(classes[0], classes[1]))


def off_branches(points: FloatArray, branches: int) -> FloatArray:
    """Subtract from each of the points (turns, groups, values) its branch, and return the rest.

    A branch is a quadratic in time, fitted to every `branches`-th point.
    """
    time = np.linspace(-1.0, 1.0, len(points))
    rest = np.empty_like(points)
    for start in range(branches):
        basis = np.vander(time[start::branches], DEGREE + 1)
        values = points[start::branches].reshape(len(basis), -1)
        fitted = basis @ np.linalg.lstsq(basis, values, rcond=None)[0]
        rest[start::branches] = (values - fitted).reshape(-1, *points.shape[1:])
    return rest


def prediction_error(values: FloatArray) -> float:
    """Return the rms error of a prediction of each of the values (n,) from the EARLIER = 6 values before it; n > 12.

    The error is divided by the standard deviation of the values; equal values have the error 0. The prediction is
    linear, with the coefficients of the least error; the rms error is corrected for their number. A motion of m
    frequencies obeys such a recurrence of order 2 m exactly, also while it settles. Chaos does not.
    """
    centred = values - values.mean()
    size = centred.std()
    if size == 0.0:
        return 0.0
    earlier = np.lib.stride_tricks.sliding_window_view(centred, EARLIER)[:-1]
    later = centred[EARLIER:]
    error = later - earlier @ np.linalg.lstsq(earlier, later, rcond=None)[0]
    return float(np.sqrt(np.sum(error**2) / (len(later) - EARLIER)) / size)


def cut(response: Response, first: int, last: int) -> Response:
    """Return the part of a response in the turns first .. last - 1. Only what the class of motion needs is cut."""
    turns = slice(first, last)
    return replace(
        response, record_turns=last - first, section_q=response.section_q[turns], section_v=response.section_v[turns]
    )


def _about(response: Response, first: int, last: int, turns: int) -> Response:
    """Return that many turns about the middle of the turns first .. last - 1, fewer in a shorter record."""
    start = max(0, min((first + last - turns) // 2, response.record_turns - turns))
    return cut(response, start, min(start + turns, response.record_turns))


def _groups(part: FloatArray) -> tuple[FloatArray, ...]:
    """Return the disk centre and the tips of a blisk, or the casing."""
    return tuple(group for group in (part[:, :1], part[:, 1:]) if group.size)


def _distance(points: FloatArray, branches: int) -> tuple[float, float]:
    """Return rms, corrected, and largest distance of the points from their branches."""
    distance = farthest(off_branches(points, branches))
    free = 1 - branches * (DEGREE + 1) / len(points)
    return float(np.sqrt(np.mean(distance**2) / free)), float(distance.max())


def _scatters(group: FloatArray, around: FloatArray) -> bool:
    """Return whether a group scatters about its branch, and cannot be predicted over the turns around."""
    if _distance(group, 1)[0] < SCATTER:
        return False
    errors = [prediction_error(component) for component in principal_components(off_branches(around, 1))]
    return float(np.median(errors)) >= UNPREDICTABLE


def _class_of(part: FloatArray, *, chaotic: bool) -> MotionClass:
    for period in range(1, MOST_BRANCHES + 1):
        rms, largest = _distance(part, period)
        if rms <= CLUSTER_RADIUS and largest <= EXCURSION:
            return MotionClass(motion=Motion.PERIOD_1 if period == 1 else Motion.PERIOD_K, period=period)
    return MotionClass(motion=Motion.CHAOTIC, period=None) if chaotic else UNDECIDED
