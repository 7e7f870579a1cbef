"""Decide the class of a motion from three indicators: clusters of the section, the 0-1 test, the Lyapunov exponent."""

from dataclasses import dataclass, field
from math import erf, hypot, lcm, log10, sqrt

from rubgen.labels.labels import Motion
from rubgen.labels.motion.chaos import CHAOTIC_FROM
from rubgen.labels.motion.clusters import CLUSTER_RADIUS
from rubgen.solver.exponent import LEAST, Exponent

CLOSE = 0.5
"""A part that repeats, with points farther from its clusters than this share of the cluster radius (6 dB below it), is
near the bound."""
REGULAR_SPREAD, CHAOTIC_SPREAD = 0.6, 0.39
"""Half the step moves log10 of a stray by so much, rms: where what strays is regular, and where it is chaotic."""
GROWTH_SPREAD = 0.1
"""Half the step moves K by less than this, unless the kind of motion changes."""
EXPONENT_SPREAD = 0.2
"""Half the step moves an exponent below 1 by so much, in 1/turn."""
ZERO_SPREAD = 0.003
"""Half the step moves an exponent near zero by so much, in 1/turn."""
UNRESOLVED_STRAY = 2.5e-3
"""Where the step does not resolve the touches, half the step may make a regular scatter chaotic, and then so large."""
KEPT = {Motion.PERIOD_1: 0.97, Motion.PERIOD_K: 0.8, Motion.QUASI_PERIODIC: 0.8, Motion.CHAOTIC: 0.98}
"""Confidence far from every bound: (runs that kept the class + 1) / (runs + 2), after Laplace. Few had the middle two.
"""
WITHOUT_EXPONENT = 0.8
"""Confidence, at most, without an exponent. It was not measured."""
_TINY = 1e-300

_REGULARITY = list(Motion)


@dataclass(frozen=True, kw_only=True)
class Indicators:
    """The indicators of the motion of one part: blisk or casing."""

    period: int | None
    """Period by clusters in turns; None without clusters."""
    stray: float
    """Rms distance from the clusters, over the part's motion."""
    growth: float
    """K of the 0-1 test, the largest of all parts: contact couples the parts."""
    exponent: Exponent | None
    """Exponent of the whole system; None where it is not known."""
    settling: bool = False
    """Whether any part still settles."""
    resolved: bool = True
    """Whether the time step resolves the touches: half of them last `classify.RESOLVED_STEPS` or more."""


@dataclass(frozen=True, kw_only=True)
class MotionClass:
    """A class of motion, its period and its confidence."""

    motion: Motion
    """The class."""
    period: int | None
    """Turns after which the motion repeats; None where it does not."""
    confidence: float = field(default=1.0, compare=False)
    """Confidence, 0 to 1."""


AT_REST = MotionClass(motion=Motion.STATIC, period=None)
FORCED = MotionClass(motion=Motion.PERIOD_1, period=1)


def decide(seen: Indicators) -> MotionClass:
    """Return the class of motion on which the indicators `seen` of a part agree. If they contradict, it is undecided.

    - Clusters: periodic at the scale of the motion. The scatter of the points within their clusters may be chaotic. If
      this scatter (`stray`) is above CLOSE times the cluster radius, and K and the exponent find chaos, the part is
      undecided.
    - No clusters, K above its bound, exponent positive: chaotic. K below its bound, exponent zero within its error:
      quasi-periodic. Anything else is undecided: a negative exponent belongs to a periodic motion that is still
      settling, or that repeats after more than 16 turns.
    - Without an exponent: clusters, then K determine the class.
    - A motion that still settles is never quasi-periodic.
    """
    motion = _class_of(seen)
    if motion is Motion.UNDECIDED:
        return MotionClass(motion=motion, period=None, confidence=0.0)
    period = seen.period if motion in (Motion.PERIOD_1, Motion.PERIOD_K) else None
    return MotionClass(motion=motion, period=period, confidence=_confidence(seen, motion))


def _class_of(seen: Indicators) -> Motion:
    chaotic = seen.growth >= CHAOTIC_FROM
    exponent = seen.exponent
    if seen.period is not None:
        near = seen.stray > CLOSE * CLUSTER_RADIUS
        if near and chaotic and exponent is not None and exponent.is_positive:
            return Motion.UNDECIDED
        return Motion.PERIOD_1 if seen.period == 1 else Motion.PERIOD_K
    if exponent is None:
        return Motion.CHAOTIC if chaotic else Motion.UNDECIDED if seen.settling else Motion.QUASI_PERIODIC
    if chaotic and exponent.is_positive:
        return Motion.CHAOTIC
    if not chaotic and not exponent.is_positive and not exponent.is_negative and not seen.settling:
        return Motion.QUASI_PERIODIC
    return Motion.UNDECIDED


def _confidence(seen: Indicators, motion: Motion) -> float:
    """Return the probability that half the step keeps the class.

    It is KEPT times the probabilities that each indicator stays on its side of its bound, by normal deviates of the
    spreads: log10 of the stray, K, the exponent. They are multiplied as if they were independent. Spreads and KEPT were
    set by the runs of `docs/confidence.md` ("fit"). Without an exponent it is WITHOUT_EXPONENT at most.
    """
    if motion in (Motion.PERIOD_1, Motion.PERIOD_K):
        confidence = KEPT[motion] * _stays_periodic(seen)
    else:
        confidence = KEPT[motion] * _stays_aperiodic(seen, chaotic=motion is Motion.CHAOTIC)
    return confidence if seen.exponent is not None else min(confidence, WITHOUT_EXPONENT)


def _stays_periodic(seen: Indicators) -> float:
    """Probability that the points stay inside their clusters and, where their scatter is regular, do not bifurcate.

    A regular motion bifurcates where its exponent reaches zero.
    """
    exponent = seen.exponent
    grows = exponent is not None and exponent.is_positive
    if (grows and seen.growth >= CHAOTIC_FROM) or not seen.resolved:
        stray = seen.stray if seen.resolved else max(seen.stray, UNRESOLVED_STRAY)
        return _normal(_decades(CLOSE * CLUSTER_RADIUS, stray) / CHAOTIC_SPREAD)
    inside = _normal(_decades(CLUSTER_RADIUS, seen.stray) / REGULAR_SPREAD)
    if exponent is None or grows:
        return inside
    return inside * _normal(-exponent.per_turn / hypot(exponent.error, ZERO_SPREAD))


def _stays_aperiodic(seen: Indicators, *, chaotic: bool) -> float:
    """Probability that the part stays outside the clusters and, where it is chaotic, that it stays so."""
    outside = _normal(_decades(seen.stray, CLUSTER_RADIUS) / (CHAOTIC_SPREAD if chaotic else REGULAR_SPREAD))
    distance = (seen.growth - CHAOTIC_FROM) / GROWTH_SPREAD
    stays = outside * _normal(distance if chaotic else -distance)
    if seen.exponent is None or not chaotic:
        return stays
    above = seen.exponent.per_turn - max(2 * seen.exponent.error, LEAST)
    return stays * _normal(above / hypot(seen.exponent.error, EXPONENT_SPREAD))


def _decades(value: float, bound: float) -> float:
    """Logarithm of value / bound to the base 10."""
    return log10(max(value, _TINY) / bound)


def _normal(deviate: float) -> float:
    """Probability of a normal deviate below this one."""
    return 0.5 * (1 + erf(deviate / sqrt(2)))


def combined(blisk: MotionClass, casing: MotionClass) -> MotionClass:
    """Combine the classes of blisk and casing into the class of the system: the less regular of the two classes.

    It is undecided if one class is undecided and none is chaotic. If the motion repeats, the period is the least common
    multiple of both periods, where a part at rest counts as 1, and the confidence is the smaller of both. If it does
    not repeat, the period is None. The confidence is then the confidence of the less regular part; for equal classes it
    is the larger of both.
    """
    worst = max(blisk, casing, key=lambda part: _REGULARITY.index(part.motion))
    alike = [part.confidence for part in (blisk, casing) if part.motion is worst.motion]
    if worst.motion in (Motion.QUASI_PERIODIC, Motion.UNDECIDED, Motion.CHAOTIC):
        return MotionClass(motion=worst.motion, period=None, confidence=max(alike))
    confidence = min(blisk.confidence, casing.confidence)
    return MotionClass(motion=worst.motion, period=lcm(blisk.period or 1, casing.period or 1), confidence=confidence)
