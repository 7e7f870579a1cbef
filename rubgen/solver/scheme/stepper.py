"""Advance one system turn by turn: its model, its state, and the output of a turn."""

from collections.abc import Iterator, Sequence

import numpy as np

from rubgen.arrays import FloatArray, frozen
from rubgen.contact.contact_kernels import wear_where_lined
from rubgen.linalg.block_kernels import bilinear
from rubgen.linalg.vector_kernels import LANES
from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import ContactLaw
from rubgen.solver.linear.admissible import check_step
from rubgen.solver.linear.system_blocks import system_blocks
from rubgen.solver.scheme.energy_kernels import ABSOLUTE, SPEED_CHANGE, WORKS, stored_energy
from rubgen.solver.scheme.model import angle_tables, at_speed, build_model, new_state
from rubgen.solver.scheme.motion_kernels import put_in_order, recover
from rubgen.solver.scheme.speed_part import SpeedPart
from rubgen.solver.scheme.state_kernels import OK, Coordinates, Snapshots
from rubgen.solver.scheme.step_kernels import advance, shift_gaps
from rubgen.solver.scheme.taps import build_taps, sampled_taps, turned_taps
from rubgen.solver.scheme.turn_kernels import STEPS, Touches, TurnEnds, TurnResult, close_touches, run_turns
from rubgen.solver.supports.support_kernels import SUPPORT_WORKS
from rubgen.taps import DEFAULT_TAPS, Tap

TURNS = 8
"""Turns in one call of the kernel: more would hardly be faster."""
FRAMES = 32
"""Frames of a turn: enough for smooth blade modes up to the 16th order of rotation."""


class Stepper:
    """Advances one system turn by turn: its `model`, its `state`, and the outputs `result`, `touches`, `snapshots`.

    The state begins at rest, undeformed; see `speed.start`. Raises UserError for a step above the stability limit.

    - system: the system at one speed.
    - contact: the contact law.
    - steps: steps of a turn of `system`. At a changing speed they become `turn_steps`, and `steps` are the steps of the
      present part of a turn.
    - start_angle: theta at the beginning of a turn, rad.
    - screen: False evaluates every blade's gap in every step; the result is the same, only slower.
    - taps: the true signals that are the rows of `result.taps`, and timing probes. They change no motion.
    - alike: the same system at other speeds. Its matrices must have the same blocks; see `follow`.
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
        self.system, self.turn_steps = system, steps
        self.blocks = system_blocks(system, *alike)
        self.model = build_model(system, contact, self.blocks, steps, start_angle=start_angle, screen=screen)
        self.steady_support, self.state = self.model.support, new_state(self.model)
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
        self._many: list[FloatArray] = []

    @property
    def steps(self) -> int:
        """Number of steps of a turn; at a changing speed of the present part of a turn."""
        return len(self.model.angles.theta) - 2

    @property
    def dt(self) -> float:
        """Time step in s."""
        return self.model.laws.dt

    @property
    def coordinates(self) -> Coordinates:
        """Read-only copies of q: `before` at the step before the next turn, `now` at its first step.

        Use `set_coordinates` to change them. `after` is valid only after a turn that has failed: it is what the failed
        step has computed. `change` is (now - before) / 2, which is not the d of `Coordinates`.
        """
        before, now, after = (self.blocks.to_q(motion.z) for motion in self.state.motions)
        for q in (before, now, after):
            q.flags.writeable = False
        return Coordinates(before, now, after, (now - before) / 2)

    def set_coordinates(self, before: FloatArray, now: FloatArray) -> None:
        """Set q (n,) at the step before the next turn (`before`) and at its first step (`now`).

        The gaps of earlier steps become unknown. Works, wear and touches stay.
        """
        motions = self.state.motions
        for motion, q in zip(motions[:2], (before, now), strict=True):
            motion.z[:] = self.blocks.to_z(q)
            recover(self.model.harmonics, motion, self.state.scratch.share)
        motions[2].z[:] = motions[1].z
        self.state.contact.step_gaps[:] = np.nan

    def follow(self, part: SpeedPart, speed: float, theta: FloatArray, section: float) -> None:
        """Continue at another speed. The next turn has as many steps as `theta` has angles, less two.

        The state stays the same, because M and dt are the same. The change of stored energy with K is added to the
        works. `result.taps` becomes a new array of zeros.

        - part: made by `speed_part` at this speed.
        - speed: in rad/s.
        - theta (steps + 2,): angles of steps 0, ..., steps and -1, rad.
        - section: time from step 0 to the Poincare section in steps; 0 in a part that does not begin at the section.
        """
        old, angles = self.model.energy.K, angle_tables(self.system, theta, section)
        self.model = at_speed(self.model, part, speed, angles)
        self.steady_support = self.model.support
        self.taps = turned_taps(self.taps, self.system, theta[: self.steps])
        self.result = self.result._replace(taps=np.zeros((len(self.result.taps), self.steps)))
        before, now = self.state.motions[0].z, self.state.motions[1].z
        change = 0.5 * (bilinear(part.energy.K, now, before) - bilinear(old, now, before))
        self.state.works[SPEED_CHANGE] += change
        self.state.works[ABSOLUTE] += abs(change)

    def grow_loads(self, start: float, end: float) -> None:
        """Set the growing loads of faults for the next turn, from `start` to `end` in s from the start of the record.

        The loads are linear in time within a turn or part of a turn: a sudden load therefore grows over it. Without
        growing loads nothing is done.
        """
        forces = self.system.turning
        if forces is None or not forces.growing:
            return
        support, steps = self.model.support, self.steps
        shares = np.array([each.ramp.share(np.array([start, end])) for each in forces.growing])
        slopes = (shares[:, 1] - shares[:, 0]) / steps
        grown = self.steady_support.loads + np.einsum("g,gmi->mi", shares[:, 0], support.growing)
        rate = np.einsum("g,gmi->mi", slopes, support.growing)
        self.model = self.model._replace(support=frozen(support._replace(loads=grown, slopes=rate)))
        springs = np.array([each.of_springs for each in forces.growing])
        rest = np.zeros(2) if self.system.spring_load is None else self.system.spring_load
        full = np.array([each.loads[0].real for each in forces.growing])[springs]
        self.taps.spring_load[:] = rest + shares[springs, 0] @ full, slopes[springs] @ full

    def run_turn(
        self, opening: FloatArray | None = None, clock: int = 0, *, recording: bool = True
    ) -> tuple[int, int, int]:
        """Integrate one turn. Its outputs are in `result`, `touches`, `snapshots` and `end`.

        - opening (steps + 2,): added to the radius of the surface at steps -1, 0, ..., steps, m; None is 0.
        - clock: number of the first step, from which the times of touches and arrivals are counted.
        - recording: False leaves out taps, orbit and arrivals. The motion is the same.

        Returns a code of `state_kernels`, the step that failed or the number of steps, and the number of touches in
        `touches.ended`.
        """
        width = np.zeros(self.steps + 2) if opening is None else opening
        return next(self.run_turns(width[None], clock, recording=recording))

    def run_turns(
        self, opening: FloatArray, clock: int = 0, *, recording: bool = True
    ) -> Iterator[tuple[int, int, int]]:
        """Integrate several turns in one call of the kernel. Yields the result of `run_turn` for each turn.

        `result`, `touches`, `snapshots` and `end` belong to the turn that was yielded last; its frames are new arrays.
        All turns are integrated before the first is yielded: `state` is the state after the last turn, and the arrivals
        of timing probes belong to the last turn. The turns end after a turn that fails.

        - opening (turns, steps + 2): as in `run_turn`, a row for each turn. More than TURNS rows are hardly faster.
        - clock, recording: as in `run_turn`.
        """
        touches, snapshots, results, ends = self._rows(len(opening))
        code, whole, step = run_turns(
            self.model, opening, clock, recording, self.state, self.taps, touches, snapshots, results, ends
        )
        last = step if code != OK else 0
        for t in range(whole + (code != OK)):
            self.touches = touches._replace(ended=touches.ended[t])
            self.snapshots = Snapshots(snapshots.steps, snapshots.z[t], snapshots.step_gaps[t])
            self.result, self.end = TurnResult(*[rows[t] for rows in results]), TurnEnds(*[rows[t] for rows in ends])
            yield (OK, self.steps, int(ends.touches[t])) if t < whole else (code, last, int(ends.touches[t]))

    def _rows(self, turns: int) -> tuple[Touches, Snapshots, TurnResult, TurnEnds]:
        """Return outputs with a row for each turn; for a single turn they are its own arrays."""
        present = self.touches.ended, self.snapshots.z, self.snapshots.step_gaps, *self.result[:-1]
        if turns == 1:
            rows = [each[None] for each in present]
        else:
            shapes = [(max(TURNS, turns), *each.shape) for each in present]
            if [each.shape for each in self._many] != shapes:
                self._many = [np.zeros(shape) for shape in shapes]
            rows = [each[:turns] for each in self._many]
        frames = np.empty((turns, *self.result.frames.shape))
        ends = TurnEnds(
            np.zeros(turns, dtype=np.int64), np.zeros((turns, WORKS)), np.zeros((turns, SUPPORT_WORKS)), np.zeros(turns)
        )
        ended, z, step_gaps, taps, section, summary, orbit = rows
        results = TurnResult(taps, section, summary, orbit, frames)
        return self.touches._replace(ended=ended), Snapshots(self.snapshots.steps, z, step_gaps), results, ends

    def begin_record(self) -> None:
        """Begin the record: the steps of a touch that is present are counted from here on."""
        self.touches.open[:, STEPS] = 0.0

    def end_record(self, clock: int) -> FloatArray:
        """End the record at the step `clock` of the run: end the present touches, and return them (touches, 8).

        The columns are those of `turn_kernels.Touches`.
        """
        return self.touches.ended[: close_touches(self.touches, clock, 0)].copy()

    def clear_works(self) -> None:
        """Set the works in `state.works` to zero. The works of the supports are kept."""
        self.state.works[:] = 0.0

    def take_frames(self, frames: int) -> None:
        """Store `frames` frames of the motion, at equal steps of every turn or part of a turn, in `result.frames`."""
        if len(self.result.frames) != frames:
            self.result = self.result._replace(frames=np.zeros((frames, self.result.frames.shape[1])))

    def take_snapshots(self, steps: list[int]) -> None:
        """Store snapshots of the state at these rising steps of every turn, in `snapshots`.

        The last step must be the end of the turn, or a step that is never reached.
        """
        numbers, blades = self.blocks.rows * LANES, self.system.n_blades
        self.snapshots = Snapshots(
            np.array(steps), np.zeros((len(steps), 2, numbers)), np.full((len(steps), 2, blades), np.nan)
        )

    def step(self, index: int, opening: FloatArray | None = None) -> tuple[int, int]:
        """Make one step from step `index` of the turn, without works, taps and touches.

        Returns a code of `state_kernels` and the number of solved contacts. `state.contact` has the force `lam` and the
        `blade` of each. `opening` (steps + 2,) is added to the radius of the surface, m; None is 0. The state moves on
        even where the step fails.
        """
        width, state = np.zeros(self.steps + 2) if opening is None else opening, self.state
        code, count = advance(self.model, index, width, *state.motions, state)
        wear_where_lined(count, self.model.surface.liner, self.dt, state.contact, state.wear)
        shift_gaps(state.contact)
        put_in_order(state.buffer, 1)
        return code, count

    def energy(self) -> float:
        """Return the stored energy E, J, half a step before the present step."""
        before, now, _ = self.state.motions
        change = self.state.scratch.z_change
        np.subtract(now.z, before.z, out=change)
        return stored_energy(self.model.energy, before.z, now.z, change, self.dt)
