"""The class of a motion from three indicators: clusters of the section, the 0-1 test, the Lyapunov exponent."""

from dataclasses import dataclass, field
from math import erf, exp, lcm, sqrt

from rubgen.labels.labels import Motion
from rubgen.labels.motion.chaos import CHAOTIC_FROM
from rubgen.labels.motion.clusters import CLUSTER_RADIUS
from rubgen.solver.exponent import LEAST, Exponent

CLOSE = 0.5
"""A part that repeats, with points farther from its clusters than this share of the cluster radius (6 dB below it), is
near the bound."""
GROWTH_WIDTH = 0.1
"""K within this of its bound is uncertain."""

_REGULARITY = list(Motion)


@dataclass(frozen=True, kw_only=True)
class Indicators:
    """The indicators of one part."""

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
    """The class on which the indicators agree, else undecided.

    - Clusters: periodic at the scale of the motion. The rest may be chaotic at a far smaller scale. Where it is not far
      smaller (CLOSE) and both other indicators find chaos, the part is undecided.
    - No clusters, K above its bound, exponent positive: chaotic. K below its bound, exponent zero within its error:
      quasi-periodic. Anything else is undecided: a negative exponent belongs to a periodic motion that is still
      settling, or that repeats after more than 16 turns.
    - Without an exponent clusters decide, then K.
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
    """Share of the class in the weights of all three kinds.

    Each indicator has a degree in [0, 1]. Periodic: c = 1 / (1 + (stray / radius)^2). Chaotic by K: a logistic function
    of K about its bound. Chaotic by the exponent: the probability that it is positive, from its error. The weight of
    periodic is c, halved where both others find chaos in the rest. The weight of chaotic is (1 - c) times the geometric
    mean of the other two. The weight of quasi-periodic is (1 - c) times the geometric mean of their complements, with
    the probability that the exponent is zero.
    """
    c = 1 / (1 + (seen.stray / CLUSTER_RADIUS) ** 2)
    k = 1 / (1 + exp(-(seen.growth - CHAOTIC_FROM) / GROWTH_WIDTH))
    positive, zero = _positive(seen.exponent), _zero(seen.exponent)
    weights = {
        "periodic": c * (1 - k * positive / 2),
        "chaotic": (1 - c) * sqrt(k * positive),
        "quasi-periodic": (1 - c) * sqrt((1 - k) * zero),
    }
    kind = "periodic" if motion in (Motion.PERIOD_1, Motion.PERIOD_K) else motion.value
    return weights[kind] / sum(weights.values())


def _positive(exponent: Exponent | None) -> float:
    if exponent is None:
        return 0.5
    return 0.5 * (1 + erf(exponent.per_turn / (sqrt(2) * max(exponent.error, LEAST))))


def _zero(exponent: Exponent | None) -> float:
    if exponent is None:
        return 0.5
    return 1 - erf(abs(exponent.per_turn) / (3 * sqrt(2) * max(exponent.error, LEAST)))


def combined(blisk: MotionClass, casing: MotionClass) -> MotionClass:
    """The less regular of the two; undecided where either is undecided and neither is chaotic.

    The period is the least common multiple of both periods; a part at rest counts as 1. The confidence is taken from
    the part which decides. For two equal classes it is the larger one where the motion does not repeat, and the smaller
    one where it does.
    """
    worst = max(blisk, casing, key=lambda part: _REGULARITY.index(part.motion))
    alike = [part.confidence for part in (blisk, casing) if part.motion is worst.motion]
    if worst.motion in (Motion.QUASI_PERIODIC, Motion.UNDECIDED, Motion.CHAOTIC):
        return MotionClass(motion=worst.motion, period=None, confidence=max(alike))
    confidence = min(blisk.confidence, casing.confidence)
    return MotionClass(motion=worst.motion, period=lcm(blisk.period or 1, casing.period or 1), confidence=confidence)
