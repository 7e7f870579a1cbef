"""What each indicator says of a rubbing run, and why they contradict each other where they do."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.labels.compact_record import CompactRecord, response_of
from rubgen.labels.labels import Motion
from rubgen.labels.motion.chaos import CHAOTIC_FROM, ROUNDING, principal_components
from rubgen.labels.motion.classify import Motions, blisk_points, casing_points, motion
from rubgen.labels.motion.clusters import (
    CLUSTER_RADIUS,
    EXCURSION,
    LONGEST_PERIOD,
    cluster_distances,
    off_cluster,
    rms,
    without_periodic_part,
)
from rubgen.solver.exponent import Exponent, lyapunov
from rubgen.solver.response import Response

LONG_PERIODS = range(LONGEST_PERIOD + 1, 65)
SETTLING = 2.0
"""What strays in the third quarter of the record over the last quarter, from which a motion is still settling."""
ONE_LINE = 0.8
GROUPS = ("disk centre", "tips", "casing")


class Clusters(StrEnum):
    """Whether every part of the section comes back within 16 turns."""

    REPEATS = "repeats"
    STRAYS = "does not"


class ZeroOne(StrEnum):
    """The 0-1 test."""

    REGULAR = "regular"
    CHAOS = "chaos"


class Sign(StrEnum):
    """Sign of the Lyapunov exponent, zero within its error."""

    NEGATIVE = "negative"
    ZERO = "zero"
    POSITIVE = "positive"


Verdict = tuple[Clusters, ZeroOne, Sign]
AGREE: dict[Verdict, str] = {
    (Clusters.REPEATS, ZeroOne.REGULAR, Sign.NEGATIVE): "periodic",
    (Clusters.STRAYS, ZeroOne.REGULAR, Sign.ZERO): "quasi-periodic",
    (Clusters.STRAYS, ZeroOne.CHAOS, Sign.POSITIVE): "chaotic",
}
"""What the three say together where they agree. All other verdicts are disagreements."""


class Cause(StrEnum):
    """Why indicators disagree; each value is its explanation."""

    SMALL_CHAOS = (
        "chaos below the scale of the motion: all parts repeat within 1 %, and both other indicators say that the "
        "rest is chaotic"
    )
    NEAR_BOUND = "as small chaos, but near the bound: the rest is more than half of 1 %, so the label is undecided"
    HIDDEN_CHAOS = (
        "chaos that the section does not show: the exponent is positive, and the part of the section that strays is "
        "regular or below single precision"
    )
    SMALL_TORUS = (
        "a second frequency below the scale of the motion: all parts repeat within 1 %, and both other indicators say "
        "that the rest is quasi-periodic"
    )
    NEUTRAL = (
        "a periodic motion that hardly attracts, as near a bifurcation: the exponent is zero within its error or "
        "within 0.001 a turn"
    )
    SMALL_NOISE = "the rest of a periodic motion, 40 dB below it, is irregular but does not grow"
    SETTLING = (
        "a transient: straying falls by more than half within the second half of the record, and the exponent is the "
        "mean over the motion before and after"
    )
    SWITCHING = "intermittent: the record has regular and irregular stretches"
    LONG_PERIOD = "a period of 17 to 64 turns; clusters search only shorter periods"
    SLOW_PHASE = (
        "the exponent is positive and K is below its bound: one spectral line has at least 80 % of the variance of "
        "the part that strays most, a vibration of the lightly damped blades that keeps its phase over the record; "
        "the rest is chaotic"
    )
    UNEXPLAINED = "none of these"


@dataclass(frozen=True, kw_only=True)
class Case:
    """One run as the indicators see it; strays are those of the system, the largest of its parts, over the motion.

    `group` is what strays most: disk centre, tips or casing. `settling` is the ratio of what strays in the third and
    the last quarter. `line_share` is how much of its leading component one spectral line holds.
    """

    name: str
    verdict: Verdict
    motion: Motion
    confidence: float
    stray: float
    group: str
    growth: float
    exponent: Exponent
    settling: float
    intermittent: bool
    long_period: int | None
    line_share: float

    @property
    def agree(self) -> bool:
        """Whether all three indicators say the same."""
        return self.verdict in AGREE

    @property
    def cause(self) -> Cause | None:
        """Why they do not."""
        return None if self.agree else _cause(self)


def judge(name: str, record: CompactRecord) -> Case | None:
    """The verdicts on a run that is kept; None where the casing rests or the companion could not follow."""
    response = response_of(record)
    exponent = lyapunov(response.companion_growth)
    if exponent is None:
        return None
    found = motion(response, exponent)
    if not found.indicators:
        return None
    groups = _groups(response)
    strays = [_least_stray(points) for points in groups.values()]
    return Case(
        name=name,
        verdict=_verdict(found, exponent),
        motion=found.system.motion,
        confidence=found.system.confidence,
        stray=max(part.stray for part in found.indicators),
        group=list(groups)[int(np.argmax(strays))],
        growth=found.indicators[0].growth,
        exponent=exponent,
        settling=_settling(groups),
        intermittent=found.intermittent,
        long_period=_long_period(groups),
        line_share=line_share(list(groups.values())[int(np.argmax(strays))]),
    )


def _verdict(found: Motions, exponent: Exponent) -> Verdict:
    repeats = all(part.period is not None for part in found.indicators)
    sign = Sign.POSITIVE if exponent.is_positive else Sign.NEGATIVE if exponent.is_negative else Sign.ZERO
    return (
        Clusters.REPEATS if repeats else Clusters.STRAYS,
        ZeroOne.CHAOS if found.indicators[0].growth >= CHAOTIC_FROM else ZeroOne.REGULAR,
        sign,
    )


def _cause(case: Case) -> Cause:
    clusters, test, sign = case.verdict
    if clusters is Clusters.REPEATS:
        if test is ZeroOne.CHAOS and sign is Sign.POSITIVE:
            return Cause.NEAR_BOUND if case.motion is Motion.UNDECIDED else Cause.SMALL_CHAOS
        if test is ZeroOne.CHAOS:
            return Cause.SMALL_NOISE
        if case.settling > SETTLING:
            return Cause.SETTLING
        if sign is Sign.POSITIVE:
            return Cause.SLOW_PHASE if case.line_share >= ONE_LINE else Cause.HIDDEN_CHAOS
        return Cause.SMALL_TORUS if case.stray > ROUNDING else Cause.NEUTRAL
    causes = {
        Cause.SETTLING: case.settling > SETTLING,
        Cause.SWITCHING: case.intermittent,
        Cause.SLOW_PHASE: sign is Sign.POSITIVE and case.line_share >= ONE_LINE,
        Cause.LONG_PERIOD: sign is not Sign.POSITIVE and case.long_period is not None,
    }
    return next((cause for cause, holds in causes.items() if holds), Cause.UNEXPLAINED)


def _groups(response: Response) -> dict[str, FloatArray]:
    """The second half of the section by groups (turns, any, values)."""
    half = response.record_turns // 2
    blisk, casing = blisk_points(response)[half:], casing_points(response)[half:]
    return dict(zip(GROUPS, (blisk[:, :1], blisk[:, 1:], casing), strict=True))


def _least_stray(points: FloatArray) -> float:
    """Rms distance from the k <= 16 clusters that leave least."""
    return min(rms(cluster_distances(points, k)) for k in range(1, LONGEST_PERIOD + 1))


def line_share(points: FloatArray) -> float:
    """Share of the leading component's variance in its strongest line and two on either side, under a Hann window."""
    rest = without_periodic_part(points)
    if rms(np.linalg.norm(rest, axis=(1, 2))) < ROUNDING:
        return 0.0
    component = principal_components(rest)[0]
    power = np.abs(np.fft.rfft(component * np.hanning(component.size))) ** 2
    line = int(np.argmax(power))
    return float(power[max(0, line - 2) : line + 3].sum() / power.sum())


def _settling(groups: dict[str, FloatArray]) -> float:
    """The largest ratio of what strays from one point in the first and the last half; 1 where it is only rounding."""
    ratios = [1.0]
    for points in groups.values():
        half = len(points) // 2
        first, last = (rms(np.linalg.norm(off_cluster(part, 1), axis=2)) for part in (points[:half], points[half:]))
        if first > ROUNDING:
            ratios.append(first / max(last, ROUNDING))
    return max(ratios)


def _long_period(groups: dict[str, FloatArray]) -> int | None:
    """The least period of 17 to 64 turns, a third of these turns at most, after which every point comes back."""
    turns = min(map(len, groups.values()))
    for k in (k for k in LONG_PERIODS if 3 * k <= turns):
        back = [np.linalg.norm(points[k:] - points[:-k], axis=2).max(axis=1) for points in groups.values()]
        if all(rms(each) <= 2**0.5 * CLUSTER_RADIUS and each.max() <= EXCURSION for each in back):
            return k
    return None
