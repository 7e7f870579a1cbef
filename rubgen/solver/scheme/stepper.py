"""A model and a state, and what a turn of theirs leaves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.contact.wear_kernels import wear_where_lined
from rubgen.linalg.block_kernels import bilinear
from rubgen.linalg.vector_kernels import LANES
from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import ContactLaw
from rubgen.solver.linear.admissible import check_step
from rubgen.solver.linear.system_blocks import system_blocks
from rubgen.solver.scheme.energy_kernels import ABSOLUTE, SPEED_CHANGE, stored_energy
from rubgen.solver.scheme.model import angle_tables, at_speed, build_model, new_state, turned
from rubgen.solver.scheme.motion_kernels import recover
from rubgen.solver.scheme.snapshot_kernels import Snapshots
from rubgen.solver.scheme.speed_part import SpeedPart
from rubgen.solver.scheme.state_kernels import Coordinates
from rubgen.solver.scheme.step_kernels import advance, shift_gaps
from rubgen.solver.scheme.taps import build_taps, sampled_taps, turned_taps
from rubgen.solver.scheme.turn_kernels import STEPS, Touches, TurnResult, close_touches, run_turn
from rubgen.taps import DEFAULT_TAPS, Tap

FRAMES = 32
"""Frames of a turn that the solver hands out: blade modes up to the 16th order of rotation move smoothly."""


class Stepper:
    """A system's `model`, its `state`, and what a turn leaves: `result`, `touches`, `snapshots`.

    `taps` are the rows of `result.taps`, timing probes apart. `start_angle` and `screen` as in `build_model`: neither
    screening nor taps change a result. The state begins at rest, undeformed; see `speed.start`.

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
        self.system, self.turn_steps, self.screen = system, steps, screen
        self.blocks = system_blocks(system, *alike)
        self.model = build_model(system, contact, self.blocks, steps, start_angle=start_angle, screen=screen)
        self.state = new_state(self.model)
        theta = self.model.angles.theta[:steps]
        self.taps = build_taps(taps, system, self.model.surface, self.blocks, self.model.laws, theta)
        n, blades = len(system.M), system.n_blades
        self.touches = Touches(
            np.zeros((blades, 8)), np.zeros(blades, dtype=np.int64), np.zeros((blades * (steps // 2 + 2), 8))
        )
        self.result = TurnResult(
            np.zeros((len(sampled_taps(taps)), steps)), np.zeros((2, n)), np.zeros(4), np.zeros(5),
            np.zeros((min(FRAMES, steps), self.blocks.rows * LANES)),
        )  # fmt: skip
        self.take_snapshots([steps])

    @property
    def steps(self) -> int:
        """Steps of a turn, or of the present part of one."""
        return len(self.model.angles.theta) - 2

    @property
    def dt(self) -> float:
        """Time step in s."""
        return self.model.laws.dt

    @property
    def coordinates(self) -> Coordinates:
        """Copies of q at the step before the next turn's first, at its first, and of the last that was written.

        Change them by `set_coordinates`. `change` is d of the last two and the one before, without meaning at a start.
        """
        before, now, after = (self.blocks.to_q(motion.z) for motion in self.state.motions)
        for q in (before, now, after):
            q.flags.writeable = False
        return Coordinates(before, now, after, (now - before) / 2)

    def set_coordinates(self, before: FloatArray, now: FloatArray) -> None:
        """Set q at the step before the turn's first and at its first, each (n,)."""
        motions = self.state.motions
        for motion, q in zip(motions[:2], (before, now), strict=True):
            motion.z[:] = self.blocks.to_z(q)
            recover(self.model.harmonics, motion, self.state.scratch.share)
        motions[2].z[:] = motions[1].z
        self.state.contact.step_gaps[:] = np.nan

    def follow(self, part: SpeedPart, speed: float, theta: FloatArray, section: float) -> None:
        """Go on at another speed (rad/s) for as many steps as `theta` (steps + 2,) has, less two: 0, ..., steps and -1.

        `section` is the time from step 0 to the section in steps, where that is one. The state carries over: M and dt
        are the same. The stored energy's change with K is added to the works.
        """
        old, angles = self.model.energy.K, angle_tables(self.system, theta, section)
        self.model = at_speed(self.model, part, speed, angles, screen=self.screen)
        self.taps = turned_taps(self.taps, self.system, theta[: self.steps])
        self.result = self.result._replace(taps=np.zeros((len(self.result.taps), self.steps)))
        before, now = self.state.motions[0].z, self.state.motions[1].z
        change = 0.5 * (bilinear(part.energy.K, now, before) - bilinear(old, now, before))
        self.state.works[SPEED_CHANGE] += change
        self.state.works[ABSOLUTE] += abs(change)

    def run_turn(
        self, opening: FloatArray | None = None, clock: int = 0, *, recording: bool = True
    ) -> tuple[int, int, int]:
        """Advance by one turn; its outputs are in `result`, `touches` and `snapshots`.

        `opening` (steps + 2,) in m at steps -1, 0, ..., steps of the turn, none by default. `clock` is the number
        that touches give to the first step. Without `recording` taps and arrivals are not made, which moves nothing
        else. Returns a code of `step_kernels`, the step where the turn ended, and the number of touches in
        `touches.ended`.
        """
        width = np.zeros(self.steps + 2) if opening is None else opening
        code, step, ended = run_turn(
            self.model, width, clock, recording, self.state, self.taps, self.touches, self.snapshots, self.result
        )
        self.state = turned(self.state, step)
        return code, step, ended

    def begin_record(self) -> None:
        """Count touches that are under way from here on."""
        self.touches.open[:, STEPS] = 0.0

    def end_record(self, clock: int) -> FloatArray:
        """End the touches that are under way at the step `clock`; these touches (any, 8)."""
        return self.touches.ended[: close_touches(self.touches, clock, 0)].copy()

    def clear_works(self) -> None:
        """Count works from here on."""
        self.state.works[:] = 0.0

    def take_frames(self, frames: int) -> None:
        """Let every turn, or part of one, leave so many frames."""
        if len(self.result.frames) != frames:
            self.result = self.result._replace(frames=np.zeros((frames, self.result.frames.shape[1])))

    def take_snapshots(self, steps: list[int]) -> None:
        """Let every turn leave snapshots at rising steps, the last of which ends it or is never reached."""
        numbers, blades = self.blocks.rows * LANES, self.system.n_blades
        self.snapshots = Snapshots(
            np.array(steps), np.zeros((len(steps), 2, numbers)), np.full((len(steps), 2, blades), np.nan)
        )

    def step(self, index: int, opening: FloatArray | None = None) -> tuple[int, int]:
        """One step from the turn's step `index`, without works, taps and touches; `state.contact` holds its contacts.

        Returns a code of `step_kernels` and the number of contacts that were solved: `lam`, `blade` and so on up to
        that number.
        """
        width, state = np.zeros(self.steps + 2) if opening is None else opening, self.state
        code, count = advance(self.model, index, width, *state.motions, state)
        wear_where_lined(count, self.model.surface.liner, self.dt, state.contact, state.wear)
        shift_gaps(state.contact)
        self.state = turned(self.state, 1)
        return code, count

    def energy(self) -> float:
        """Stored energy E half a step before now, J."""
        before, now, _ = self.state.motions
        change = self.state.scratch.z_change
        np.subtract(now.z, before.z, out=change)
        return stored_energy(self.model.energy, before.z, now.z, change, self.dt)
