"""The scheme set up for one system: it holds a state and advances it turn by turn."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.contact.clearance_kernels import LARGEST_SPREAD, NEAREST_SHARE
from rubgen.contact.contact_kernels import ContactWork
from rubgen.contact.geometry import blade_tips, casing_surface, with_zeros
from rubgen.contact.geometry_kernels import Surface, Tips
from rubgen.contact.wear_kernels import wear
from rubgen.linalg.block_kernels import bilinear
from rubgen.linalg.blocks import aligned, padded, share_width, system_harmonics
from rubgen.linalg.vector_kernels import LANES
from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import ContactLaw
from rubgen.solver.linear.admissible import check_step
from rubgen.solver.linear.system_blocks import system_blocks
from rubgen.solver.scheme.central_difference import compliances, energy_book, scheme
from rubgen.solver.scheme.energy_kernels import ABSOLUTE, SPEED_CHANGE, stored_energy
from rubgen.solver.scheme.model_kernels import Angles, Laws, Model, Scratch, State
from rubgen.solver.scheme.motion_kernels import Motion, recover
from rubgen.solver.scheme.snapshot_kernels import Marks
from rubgen.solver.scheme.speed_part import SpeedPart
from rubgen.solver.scheme.step_kernels import advance, shift_held
from rubgen.solver.scheme.supports import support_of
from rubgen.solver.scheme.taps import build_taps, sampled_taps, turned_taps
from rubgen.solver.scheme.turn_kernels import Touches, TurnResult, run_turn
from rubgen.taps import DEFAULT_TAPS, Tap

CANDIDATE_MARGIN_SHARE = 5e-5
"""Blades nearer than this share of the tip radius are solved together; a step widens it where forces reach farther."""
CASING_LIMIT_SHARE = 0.025
"""A casing node displaced by this share of the tip radius (10 mm at 0.4 m: eight times the preset casing's thickness,
seven times its largest regular response) is beyond what a linear ring can mean."""
TIP_LIMIT_SHARE = 0.025
"""The same for a tip (10 mm): a cantilever of the preset's blades, 150 mm long and 3.9 mm thick at the root, has
3 E (h/2) w / L^2 = 0.5 GPa there, the yield stress of good steel, and its tip has drawn back by 3 w^2 / (5 L) = 0.4 mm,
which a linear beam does not have and which is more than the clearance."""
FRAMES = 32
"""Frames of a turn that the solver hands out: blade modes up to the 16th order of rotation move smoothly."""


def tip_spread(tips: Tips, tip_limit: float) -> float:
    """How far, in tip radii, a tip is from its place at rest along either axis, as long as no run has diverged."""
    return (tip_limit + float(np.abs(tips.static[:2]).max(initial=0.0))) / tips.radius


def bounds_hold(surface: Surface, spread: float, casing_limit: float) -> bool:
    """Whether the bounds of `clearance_kernels` hold in every state of a run that has not diverged.

    They take tips within a quarter of their radius of their place, and a surface whose radius is nowhere below 0.9 of
    its mean, `casing_limit` (m) being its largest displacement. Blades of any machine are far within; the one "tip" of
    a Jeffcott rotor, which stands on the axis, is not. Tests: tests/solver/test_screening.py.
    """
    narrowest = surface.mean_radius - float(np.abs(surface.amplitude).sum()) - surface.inset - casing_limit
    return spread < LARGEST_SPREAD and narrowest > NEAREST_SHARE * surface.mean_radius


class Stepper:
    """A system, a contact law and a number of steps per turn, with the state between them.

    `start_angle` is theta at the beginning of each turn, rad. `screen` False evaluates every blade's gap in every
    step, which never changes a result; where `bounds_hold` is false that is always done. `taps` are the rows of
    `result.taps`, timing probes apart. The state begins at rest, undeformed; see `speed.start`.

    `alike` are the same system at other speeds, whose matrices must fall into the same blocks; see `follow`. `steps`
    are then those of the present part, `turn_steps` those of a turn of `system`. Raises UserError for a step above the
    stability limit.
    """

    def __init__(
        self,
        system: SpinningSystem,
        contact: ContactLaw,
        steps: int,
        *,
        start_angle: float = 0.0,
        screen: bool = True,
        taps: tuple[Tap, ...] = DEFAULT_TAPS,
        alike: Sequence[SpinningSystem] = (),
    ) -> None:
        check_step(system, steps)
        self.system, self.steps, self.turn_steps = system, steps, steps
        self.dt = 2 * np.pi / system.speed / steps
        self.surface, self.tips = casing_surface(system, contact), blade_tips(system)
        margin = CANDIDATE_MARGIN_SHARE * system.tip_radius
        limits = CASING_LIMIT_SHARE * system.tip_radius, TIP_LIMIT_SHARE * system.tip_radius
        lasting = contact.restitution > 0 or contact.liner is not None
        self.screen, spread = screen, tip_spread(self.tips, limits[1])
        self.laws = Laws(
            float(system.speed), float(self.dt), contact.friction, contact.restitution, margin, *limits, spread,
            lasting, screen and bounds_hold(self.surface, spread, limits[0]),
        )  # fmt: skip
        self.blocks = system_blocks(system, *alike)
        self.scheme = scheme(system.M, system.C, system.K, system.force, self.dt, self.blocks)
        self.harmonics = system_harmonics(self.blocks, system.n_blades)
        self.compliances = compliances(system, self.dt)
        self.support = support_of(system, self.blocks, self.dt)
        theta = start_angle + 2 * np.pi * (np.arange(steps + 1) % steps) / steps  # the last step is the first exactly
        self.angles = _angles(system, np.append(theta, theta[-2]))
        self.taps = build_taps(taps, system, self.surface, self.blocks, self.laws, theta[:-1])
        self.book = energy_book(system, self.blocks)
        self.work = _contact_work(system)
        n, blades = system.M.shape[0], system.n_blades
        self.touches = Touches(
            np.zeros((blades, 8)), np.zeros(blades, dtype=np.int64), np.zeros((blades * (steps // 2 + 2), 8))
        )
        self.result = TurnResult(
            np.zeros((len(sampled_taps(taps)), steps)), np.zeros((2, n)), np.zeros(4), np.zeros(5),
            np.zeros((min(FRAMES, steps), self.blocks.rows * LANES)),
        )  # fmt: skip
        self.motions = self.new_motions()
        self.scratch = self._scratch()
        self.marks = self.marks_at([steps])
        self.set_state(np.zeros(n), np.zeros(n))

    @property
    def model(self) -> Model:
        """What the kernels take of all that does not change."""
        return Model(
            self.surface, self.tips, self.laws, self.angles, self.scheme, self.harmonics, *self.compliances,
            self.support,
        )  # fmt: skip

    @property
    def state(self) -> State:
        """Copies of q at the step before the next turn's first, at its first, and of the last that was written.

        Change the state by `set_state`. `change` is d of the last two and the one before, without meaning at a start.
        """
        before, now, after = (self.blocks.to_q(motion.z) for motion in self.motions)
        for q in (before, now, after):
            q.flags.writeable = False
        return State(before, now, after, (now - before) / 2)

    def part_of(self, system: SpinningSystem) -> SpeedPart:
        """What follows the speed, of the same system at another speed."""
        return SpeedPart(
            blade_tips(system),
            scheme(system.M, system.C, system.K, system.force, self.dt, self.blocks),
            compliances(system, self.dt),
            energy_book(system, self.blocks, zeros=True),
            support_of(system, self.blocks, self.dt),
        )

    def follow(self, part: SpeedPart, speed: float, theta: FloatArray, section: float) -> None:
        """Go on at another speed (rad/s) for as many steps as `theta` (steps + 2,) has, less two: 0, ..., steps and -1.

        `section` is the time from step 0 to the section in steps, where that is one. The state carries over: M and dt
        are the same. The stored energy's change with K is booked as a work.
        """
        old = self.book.K
        self.tips, self.scheme, self.compliances = part.tips, part.scheme, part.compliances
        self.book = part.book._replace(works=self.book.works)
        self.support = part.support._replace(works=self.support.works)
        spread = tip_spread(part.tips, self.laws.tip_limit)
        screen = self.screen and bounds_hold(self.surface, spread, self.laws.casing_limit)
        self.laws = self.laws._replace(speed=speed, spread=spread, screen=screen)
        self.steps = len(theta) - 2
        self.angles = _angles(self.system, theta, section)
        self.taps = turned_taps(self.taps, self.system, theta[: self.steps])
        self.result = self.result._replace(taps=np.zeros((len(self.result.taps), self.steps)))
        before, now = self.motions[0].z, self.motions[1].z
        change = 0.5 * (bilinear(self.book.K, now, before) - bilinear(old, now, before))
        self.book.works[SPEED_CHANGE] += change
        self.book.works[ABSOLUTE] += abs(change)

    def set_state(self, before: FloatArray, now: FloatArray) -> None:
        """Set q at the step before the turn's first and at its first, each (n,)."""
        for motion, q in zip(self.motions[:2], (before, now), strict=True):
            motion.z[:] = self.blocks.to_z(q)
            recover(self.harmonics, motion, self.scratch.share)
        self.motions[2].z[:] = self.motions[1].z
        self.work.held[:] = np.nan

    def run_turn(
        self, opening: FloatArray | None = None, clock: int = 0, *, recording: bool = True
    ) -> tuple[int, int, int]:
        """Advance by one turn; its outputs are in `result` and `touches`.

        `opening` (steps + 2,) in m at steps -1, 0, ..., steps of the turn, none by default. `clock` is the number
        that touches give to the first step. Without `recording` taps and arrivals are not made, which moves nothing
        else. Returns a code of `step_kernels`, the step where the turn ended, and the
        number of touches in `touches.ended`.
        """
        width = np.zeros(self.steps + 2) if opening is None else opening
        code, step, ended = run_turn(
            self.model, width, clock, recording, self.motions, self.work, self.scratch, self.book, self.taps,
            self.touches, self.marks, self.result,
        )  # fmt: skip
        self._turn_motions(step)
        return code, step, ended

    def marks_at(self, steps: list[int]) -> Marks:
        """Marks at rising steps of a turn, the last of which ends it; set as `marks`, turns fill them."""
        numbers, blades = self.blocks.rows * LANES, self.system.n_blades
        return Marks(np.array(steps), np.zeros((len(steps), 2, numbers)), np.full((len(steps), 2, blades), np.nan))

    def new_motions(self) -> tuple[Motion, Motion, Motion]:
        """Room for the states of three steps."""
        return self._motion(), self._motion(), self._motion()

    def new_work(self) -> tuple[ContactWork, Scratch]:
        """Scratch of another trajectory of the same system."""
        return _contact_work(self.system), self._scratch()

    def step(self, index: int, opening: FloatArray | None = None) -> tuple[int, int]:
        """One step from the turn's step `index`, without book, taps and touches; `work` holds its contacts.

        Gives a code of `step_kernels` and the number of contacts that were solved: `work.lam`, `work.blade` and so on
        up to that number.
        """
        width = np.zeros(self.steps + 2) if opening is None else opening
        code, count = advance(self.model, index, width, *self.motions, self.work, self.scratch)
        wear(count, self.surface.liner, self.dt, self.work)
        shift_held(self.work)
        self._turn_motions(1)
        return code, count

    def energy(self) -> float:
        """Stored energy E half a step before now, J."""
        before, now, _ = self.motions
        np.subtract(now.z, before.z, out=self.scratch.z_change)
        return stored_energy(self.book, before.z, now.z, self.scratch.z_change, self.dt)

    def _turn_motions(self, steps: int) -> None:
        """The motions as they stand after so many steps."""
        first = steps % 3
        order = self.motions[first:] + self.motions[:first]
        self.motions = (order[0], order[1], order[2])

    def _motion(self) -> Motion:
        rows, width = self.blocks.rows, self.harmonics.basis.shape[1]
        n = self.system.M.shape[0]
        return Motion(aligned(np.zeros(rows * LANES)), aligned(np.zeros((2, width))), aligned(np.zeros(n)))

    def _scratch(self) -> Scratch:
        numbers, (blades, width) = self.blocks.rows * LANES, self.harmonics.basis.shape
        shares = share_width(blades)
        return Scratch(
            self._motion(), aligned(np.zeros(numbers)), aligned(np.zeros(numbers)), aligned(np.zeros((3, shares))),
            aligned(np.zeros(self.system.M.shape[0])), aligned(np.zeros((3, width))),
        )  # fmt: skip


def _angles(system: SpinningSystem, theta: FloatArray, section: float = 0.0) -> Angles:
    """Tables at the angles of steps 0, ..., steps and -1."""
    orders = np.multiply.outer(theta, system.surface.order) - system.surface.order * system.surface.phase
    return Angles(theta, np.cos(theta), np.sin(theta), np.cos(orders), np.sin(orders), section)


def _contact_work(system: SpinningSystem) -> ContactWork:
    """Arrays of the contact step."""
    m, c = system.n_blades, system.n_casing
    return ContactWork(
        casing=with_zeros(np.zeros(c)), bounds=np.full(padded(m), np.inf), psi=np.zeros(m), gap=np.zeros(m),
        tangent=np.zeros((m, 2)), held=np.full((3, m), np.nan), blade=np.zeros(m, dtype=np.int64), lam=np.zeros(m),
        b=np.zeros(m), W=np.zeros((m, m)), normal_tip=np.zeros((m, 3)), full_tip=np.zeros((m, 3)),
        normal_casing=np.zeros((m, c)), full_casing=np.zeros((m, c)), slip=np.zeros((m, 2)), sliding=np.zeros(m),
        casing_response=np.zeros((m, c)), ends=np.zeros(8),
        rows=np.zeros((2, c)), square=np.zeros((m, m)), tableau=np.zeros((m, 2 * m + 2)),
        basis=np.zeros(m, dtype=np.int64),
    )  # fmt: skip
