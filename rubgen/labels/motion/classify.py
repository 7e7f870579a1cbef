"""Classify the steady motion of blisk, casing and both, from the Poincare section."""

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.errors import UserError
from rubgen.labels.labels import Motion
from rubgen.labels.motion.chaos import chaos_indicator
from rubgen.labels.motion.clusters import cluster_distances, cluster_period, late_distances, settles, stray
from rubgen.labels.motion.decision import AT_REST, FORCED, Indicators, MotionClass, combined, decide
from rubgen.labels.motion.intermittency import Segment, is_intermittent, segments
from rubgen.labels.motion.section import blisk_points, casing_points, casing_rests, is_symmetric
from rubgen.solver.exponent import Exponent
from rubgen.solver.response import Response

__all__ = ["Motions", "blisk_points", "casing_points", "chaos_indicator", "cluster_distances", "motion"]

LEAST_TURNS = 32
RESOLVED_STEPS = 4
"""Touches are resolved where half of them last so many steps. Among the runs of `docs/confidence.md`, the median touch
of some lasts two steps or less: with half the time step they have as many steps of contact. In all other runs it lasts
six steps or more, and with half the time step they have nearly twice as many."""


@dataclass(frozen=True, kw_only=True)
class Motions:
    """Classes of motion of the blisk, of the casing, and of the whole system, with the indicators that led to them."""

    blisk: MotionClass
    """Class of the blisk."""
    casing: MotionClass
    """Class of the casing."""
    system: MotionClass
    """Class of both together."""
    indicators: tuple[Indicators, ...] = ()
    """Indicators of the blisk and, where it moves, of the casing; none for the forced motion without contact."""
    symmetric: bool | None = None
    """Whether the motion has the symmetry of the lobes; None unless it is period-1 in contact."""
    tip_chatter: bool = False
    """Whether the tips do not repeat while disk centre and casing do."""
    stretches: tuple[Segment, ...] = ()
    """Regular and irregular stretches of a motion that is chaotic or undecided as a whole; else empty."""

    @property
    def settling(self) -> bool:
        """Whether the motion still settles in the second half of the record."""
        return any(part.settling for part in self.indicators)

    @property
    def segments(self) -> tuple[Segment, ...]:
        """The segments of an intermittent motion, which switches between regular and irregular.

        Empty for any other motion.
        """
        return self.stretches if self.stretches and is_intermittent(list(self.stretches)) else ()

    @property
    def intermittent(self) -> bool:
        """Whether the motion switches between regular and irregular."""
        return bool(self.segments)


def motion(response: Response, exponent: Exponent | None = None) -> Motions:
    """Classify the motion of a run from its Poincare section and its Lyapunov exponent.

    Raises UserError below 32 turns. `exponent` is None if it was not computed. Blisk and casing are each periodic or
    not by their own clusters. The 0-1 test uses the disk centre, the tips and the casing. Its largest K counts for all
    of them: contact couples them into one system, which is chaotic as a whole. A lightly damped blade with random
    excitation looks regular for longer than the record; the disk centre does not. Without contact the motion is the
    forced motion, which repeats every turn, and the casing is at rest, if this motion is known
    (`Response.knows_free_motion`). If it is not known, because a support is not linear, the section is classified as
    with contact.
    """
    turns = response.section_q.shape[0]
    if turns < LEAST_TURNS:
        raise UserError(f"record_turns = {turns}: a motion needs at least {LEAST_TURNS} turns, reliably 500; raise it")
    touches = response.contact_steps_per_turn.sum() > 0
    if not touches and response.knows_free_motion:
        return Motions(blisk=FORCED, casing=AT_REST, system=FORCED)
    parts = [blisk_points(response)] if casing_rests(response) else [blisk_points(response), casing_points(response)]
    steps = response.events.steps
    resolved = not steps.size or bool(np.median(steps) >= RESOLVED_STEPS)
    seen = indicators(parts, exponent, resolved=resolved)
    classes = [*(decide(part) for part in seen), AT_REST][:2]
    system = combined(classes[0], classes[1])
    return Motions(
        blisk=classes[0],
        casing=classes[1],
        system=system,
        indicators=seen,
        symmetric=is_symmetric(response) if touches and system.motion is Motion.PERIOD_1 else None,
        tip_chatter=_tips_alone_stray(parts, seen),
        stretches=_stretches(parts, system.motion),
    )


def indicators(parts: list[FloatArray], exponent: Exponent | None, *, resolved: bool = True) -> tuple[Indicators, ...]:
    """Compute the indicators of the blisk and, if it moves, of the casing, in the order of `parts`.

    - parts: points (turns, groups, values) of the section, from `blisk_points` and `casing_points`; at least one part
      and LEAST_TURNS turns.
    - exponent: Lyapunov exponent of the system, or None. Every part gets it.
    - resolved: whether the time step resolves the touches. Every part gets it.

    Each part has its own period (`cluster_period`) and rms distance from the clusters (`stray`). All parts have one K
    of the 0-1 test, the largest of any part (`chaos_indicator`). All parts settle if any part settles (`settles`).
    """
    distances = [late_distances(part) for part in parts]
    periods = [cluster_period(each) for each in distances]
    strays = [stray(each, period) for each, period in zip(distances, periods, strict=True)]
    growth = max(chaos_indicator(part) for part in parts)
    settling = any(settles(each) for each in distances)
    return tuple(
        Indicators(period=period, stray=size, growth=growth, exponent=exponent, settling=settling, resolved=resolved)
        for period, size in zip(periods, strays, strict=True)
    )


def _tips_alone_stray(parts: list[FloatArray], seen: tuple[Indicators, ...]) -> bool:
    """Return whether the blisk does not repeat, but the disk centre and the casing by themselves do."""
    blisk, *casing = (part.period for part in seen)
    return blisk is None and None not in casing and cluster_period(late_distances(parts[0][:, :1])) is not None


def _stretches(parts: list[FloatArray], whole: Motion) -> tuple[Segment, ...]:
    """Return the stretches of a motion that is not regular as a whole."""
    return tuple(segments(parts)) if whole in (Motion.CHAOTIC, Motion.UNDECIDED) else ()
