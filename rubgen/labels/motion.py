"""Class of the steady motion from the section: clusters first, then the 0-1 test."""

from __future__ import annotations

from dataclasses import dataclass
from math import lcm

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.errors import UserError
from rubgen.labels.labels import Motion
from rubgen.labels.zero_one_test import growth_correlation
from rubgen.solver.response import Response

LEAST_TURNS = 32
LONGEST_PERIOD = 16
CLUSTER_RADIUS = 0.01
"""Points stray from the mean of their cluster by 1 % of the part's motion at most, rms over turns: by -40 dB."""
EXCURSION = 0.03
"""No single point strays by more than this."""
CHAOTIC_FROM = 0.7
"""K of the 0-1 test from which a motion is chaotic: chaotic maps of exponent > 0.1 give 0.8 to 1 on 500 points."""
ROUNDING = 1e-6
"""What strays by less than this share of the part's motion may be rounding or the rest of a transient."""
OBSERVABLES = 3
"""Most principal components that the 0-1 test looks at; each must hold 1 % of the leading one's variance."""
REST_ENERGY = 5e-12
"""A casing with less energy than this, in J, stands still: 1 nm of 7 kg at 180 Hz."""

_REGULARITY = list(Motion)


@dataclass(frozen=True, kw_only=True)
class MotionClass:
    """A class, and after how many turns the motion repeats (None for what does not move or does not repeat)."""

    motion: Motion
    period: int | None


@dataclass(frozen=True, kw_only=True)
class Motions:
    """Classes of the blisk, of the casing, and of both together."""

    blisk: MotionClass
    casing: MotionClass
    system: MotionClass


AT_REST = MotionClass(motion=Motion.STATIC, period=None)
FORCED = MotionClass(motion=Motion.PERIOD_1, period=1)


def motion(response: Response) -> Motions:
    """The motion classes of a run from its section; raises UserError below 32 turns.

    Each part is periodic or not by its own clusters. What is not is chaotic where the 0-1 test finds chaos in the disk
    centre, the tips or the casing: contact couples them into one system, which is chaotic as a whole. A lightly damped
    blade that is shaken at random looks regular for longer than the record lasts; the disk centre shows it.
    """
    turns = response.section_q.shape[0]
    if turns < LEAST_TURNS:
        raise UserError(f"record_turns = {turns}: a motion needs at least {LEAST_TURNS} turns, reliably 500; raise it")
    if response.contact_steps_per_turn.sum() == 0:
        return Motions(blisk=FORCED, casing=AT_REST, system=FORCED)
    parts = [blisk_points(response)] if _casing_rests(response) else [blisk_points(response), casing_points(response)]
    periods = [cluster_period(part) for part in parts]
    growth = 0.0 if None not in periods else max(chaos_indicator(part) for part in parts)
    classes = [motion_class(period, growth) for period in periods] + [AT_REST]
    return Motions(blisk=classes[0], casing=classes[1], system=combined(classes[0], classes[1]))


def motion_class(period: int | None, growth: float) -> MotionClass:
    """Periodic with this period, or without one chaotic or quasi-periodic by the K of the 0-1 test."""
    if period is not None:
        return MotionClass(motion=Motion.PERIOD_1 if period == 1 else Motion.PERIOD_K, period=period)
    return MotionClass(motion=Motion.CHAOTIC if growth >= CHAOTIC_FROM else Motion.QUASI_PERIODIC, period=None)


def combined(blisk: MotionClass, casing: MotionClass) -> MotionClass:
    """The less regular of the two; the period is the least common multiple of theirs, a part at rest counting as 1."""
    worst = max(blisk, casing, key=lambda part: _REGULARITY.index(part.motion))
    if worst.motion in (Motion.QUASI_PERIODIC, Motion.CHAOTIC):
        return MotionClass(motion=worst.motion, period=None)
    return MotionClass(motion=worst.motion, period=lcm(blisk.period or 1, casing.period or 1))


def blisk_points(response: Response) -> FloatArray:
    """Section of the blisk (turns, groups, 4) over the size of its motion, the orbital speed of O_d.

    Group 0 is O_d: Omega x, Omega y, v_x, v_y; groups 1 .. are the tips: Omega times their three displacements.
    The absolute velocity of O_d, v + Omega e_z x u, has the orbit's size even where it rests in the turning frame.
    """
    q, v, speed = response.section_q, response.section_v, response.speed
    centre = 3 * response.n_blades
    x, y, v_x, v_y = q[:, centre], q[:, centre + 1], v[:, centre], v[:, centre + 1]
    size = np.sqrt(np.mean((v_x - speed * y) ** 2 + (v_y + speed * x) ** 2))
    tips = speed * q[:, :centre].reshape(q.shape[0], response.n_blades, 3)
    points = np.zeros((q.shape[0], response.n_blades + 1, 4))
    points[:, 0] = np.stack([speed * x, speed * y, v_x, v_y], axis=1)
    points[:, 1:, :3] = tips
    return np.asarray(points / size, dtype=np.float64)


def casing_points(response: Response) -> FloatArray:
    """Section of the casing (turns, 1, 2 modes): Omega times modal displacement, and speed, over their rms norm.

    Between two touches the casing swings freely about its rest shape, so its displacement there is motion. The time
    average that touches leave is no offset of the section; only a touch that never ends would make it one.
    """
    modes = slice(response.section_q.shape[1] - response.n_casing, None)
    states = np.concatenate([response.speed * response.section_q[:, modes], response.section_v[:, modes]], axis=1)
    size = np.sqrt(np.mean(np.sum(states**2, axis=1)))
    return np.asarray(states[:, None, :] / size, dtype=np.float64)


def chaos_indicator(points: FloatArray) -> float:
    """Largest K of the first group of the points and of the others: for a blisk, of the disk centre and of the tips.

    Each is the median K of the 0-1 test over the leading principal components of those points without their periodic
    part. Where the first half of the record strays more than twice as far as the second, it is still settling, and the
    second alone is tested. A group that strays by less than ROUNDING has K = 0.
    """
    half = points.shape[0] // 2
    first, second = (_rms(without_periodic_part(part)) for part in (points[:half], points[half:]))
    steady = points[half:] if first > 2 * second else points
    return max(_group_indicator(group) for group in (steady[:, :1], steady[:, 1:]) if group.size)


def _group_indicator(points: FloatArray) -> float:
    rest = without_periodic_part(points)
    if _rms(np.linalg.norm(rest, axis=(1, 2))) < ROUNDING:
        return 0.0
    return float(np.median([growth_correlation(observable) for observable in principal_components(rest)]))


def cluster_period(points: FloatArray) -> int | None:
    """Smallest k <= 16 after which the points come back, or None.

    Looks at the second half of the record, where transients have died. A point's distance to the mean of its cluster is
    that of its farthest group (so that one chattering tip counts); rms over turns it must be CLUSTER_RADIUS at most,
    for no turn above EXCURSION, and it must not grow.
    """
    late = points[points.shape[0] // 2 :]
    longest = min(LONGEST_PERIOD, late.shape[0] // 4)
    for period in range(1, longest + 1):
        distance = cluster_distances(late, period)
        if _rms(distance) <= CLUSTER_RADIUS and distance.max() <= EXCURSION and not _grows(distance):
            return period
    return None


def cluster_distances(points: FloatArray, period: int) -> FloatArray:
    """Distance of each point (turns, groups, values) to its cluster's mean, the largest of its groups."""
    return np.asarray(np.linalg.norm(_off_cluster(points, period), axis=2).max(axis=1), dtype=np.float64)


def without_periodic_part(points: FloatArray) -> FloatArray:
    """The points less the means of their k clusters, k <= 16 being the one that leaves the least variance.

    A motion that wanders within bands which it visits in turn would otherwise look regular: the bands outweigh it. The
    variance is divided by turns - k, so that more clusters alone are no gain.
    """
    turns = points.shape[0]
    left = [_off_cluster(points, k) for k in range(1, min(LONGEST_PERIOD, turns // 8) + 1)]
    variance = [np.sum(rest**2) / (turns - k) for k, rest in enumerate(left, start=1)]
    return left[int(np.argmin(variance))]


def _off_cluster(points: FloatArray, period: int) -> FloatArray:
    """Points less the mean of every period-th point."""
    residual = points.copy()
    for phase in range(period):
        residual[phase::period] -= points[phase::period].mean(axis=0)
    return residual


def principal_components(points: FloatArray) -> FloatArray:
    """The leading principal components (1 .. OBSERVABLES, turns) of the section, each without its mean.

    Components below 1 % of the leading one's variance are left out: they may be rounding.
    """
    flat = points.reshape(points.shape[0], -1)
    left, size, _ = np.linalg.svd(flat - flat.mean(axis=0), full_matrices=False)
    count = min(OBSERVABLES, int(np.sum(size**2 >= 0.01 * size[0] ** 2)))
    return np.asarray((left * size).T[:count], dtype=np.float64)


def _grows(distance: FloatArray) -> bool:
    """Whether the later half is more than twice as far as the earlier one and no longer tiny: an orbit being left."""
    half = distance.size // 2
    earlier, later = _rms(distance[:half]), _rms(distance[half:])
    return later > 2 * earlier and later > CLUSTER_RADIUS / 10


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _casing_rests(response: Response) -> bool:
    """Whether the casing's energy (mass-normalised modes) stays below REST_ENERGY in the second half of the record."""
    half = response.section_q.shape[0] // 2
    modes = slice(response.section_q.shape[1] - response.n_casing, None)
    q, v = response.section_q[half:, modes], response.section_v[half:, modes]
    energy = (np.sum(v**2, axis=1) + response.speed**2 * np.sum(q**2, axis=1)) / 2
    return bool(energy.max() < REST_ENERGY)
