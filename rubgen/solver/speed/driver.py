"""How a stepper is taken through a turn: at a steady speed in one call, at a changing one in short parts."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np

from rubgen.arrays import FloatArray, IntArray
from rubgen.scenario.rotation import Rotation, steady_rotation
from rubgen.solver.linear.rub_free import RubFreeMotion
from rubgen.solver.scheme.step_kernels import OK
from rubgen.solver.scheme.stepper import FRAMES, Stepper
from rubgen.solver.scheme.turn_kernels import TurnResult
from rubgen.solver.speed.interpolation import Following

SPEED_SHARE = 2e-4
"""Within a part, whose matrices stand still at its middle speed, the speed changes by this share at most."""
MOST_PARTS = 64
NEVER = 2**62
"""A snapshot at no step of a part."""

Opening = Callable[[FloatArray], FloatArray]
"""How far the surface is opened, m, after so many turns from the start."""


class TurnFrames(NamedTuple):
    """Some 32 moments of a turn: `step` (frames,) their numbers, `z` (frames, any) the motion in its blocks."""

    step: IntArray
    z: FloatArray


class Spin(Protocol):
    """Takes a stepper turn by turn from the start; steps are numbered from the start of the record.

    `settle` turns go before the record. What the last turn gave: `result` with taps, section, summary; `touches`,
    arrays of touches that ended; `arrivals` (any, 4) under timing probes; `opening` of the surface in its last part;
    `frames` of the motion, and `tip_growth` (n_blades, 3), the tips' steady displacement at its beginning in m.
    """

    stepper: Stepper
    settle: int
    rotation: Rotation
    result: TurnResult
    touches: list[FloatArray]
    arrivals: FloatArray
    opening: FloatArray
    frames: TurnFrames
    tip_growth: FloatArray

    def first_step(self, turn: int) -> int:
        """Number of the step at which a turn begins."""
        ...

    def run_turn(self, turn: int, opening: Opening, *, recording: bool) -> tuple[int, int]:
        """One turn; a code of `step_kernels`, and the step of the turn where it ended. Taps only where recording."""
        ...


class SteadySpin:
    """A constant speed: every turn is one part with the same steps; the record begins after `settle` turns."""

    def __init__(self, stepper: Stepper, settle: int) -> None:
        self.stepper, self.settle = stepper, settle
        self.rotation = steady_rotation(stepper.system.speed)
        self.result, self.touches = stepper.result, list[FloatArray]()
        self.arrivals, self.opening = np.zeros((0, 4)), np.zeros(0)
        self.frames, self.tip_growth = _frames(stepper.result, 0, 0), stepper.system.tip_static

    def first_step(self, turn: int) -> int:
        """Number of the step at which a turn begins."""
        return (turn - self.settle) * self.stepper.steps

    def run_turn(self, turn: int, opening: Opening, *, recording: bool) -> tuple[int, int]:
        """One turn; a code of `step_kernels`, and the step of the turn where it ended. Taps only where recording."""
        steps = self.stepper.steps
        self.opening = opening(turn + np.arange(-1, steps + 1) / steps)
        code, step, ended = self.stepper.run_turn(self.opening, self.first_step(turn), recording=recording)
        self.result, self.touches = self.stepper.result, [self.stepper.touches.ended[:ended].copy()]
        self.arrivals = _arrivals(self.stepper)
        self.frames = _frames(self.result, self.first_step(turn), steps)
        return code, step


class ChangingSpin:
    """A speed that follows a rotation, theta = 0 at t = 0, where the record begins after `settle` turns.

    Time steps are equal: a turn has as many as fit, and begins at the step that is nearest to theta = 0 mod 2 pi. Each
    turn is cut into equal parts in which the speed changes by SPEED_SHARE at most; the matrices of a part are those of
    the speed in its middle, so the error falls with the square of a part's length. What the tips' mean steady growth
    closes follows every step, through the opening of the surface.
    """

    def __init__(self, stepper: Stepper, following: Following, rotation: Rotation, settle: int) -> None:
        self.stepper, self.following, self.rotation, self.settle = stepper, following, rotation, settle
        self.result, self.touches = stepper.result, list[FloatArray]()
        self.arrivals, self.opening = np.zeros((0, 4)), np.zeros(0)
        self.frames, self.tip_growth = _frames(stepper.result, 0, 0), stepper.system.tip_static
        stepper.take_snapshots([NEVER])

    def begin(self, motion: RubFreeMotion) -> None:
        """Put the stepper into a rub-free motion, without works so far."""
        start = np.array([self._time_of(0)])
        speed = self.rotation.speed(start)
        part = next(self.following.at(speed, self.rotation.acceleration(start)))
        self.stepper.follow(part, float(speed[0]), np.zeros(3), 0.0)
        first = self.first_step(0)
        angles = self.rotation.angle((first + np.array([-1, 0])) * self.stepper.dt)
        self.stepper.set_coordinates(*(motion.at(angle) for angle in angles.tolist()))
        self.stepper.state.works[:] = 0.0

    def first_step(self, turn: int) -> int:
        """Number of the step at which a turn begins."""
        return round(self._time_of(turn) / self.stepper.dt)

    def run_turn(self, turn: int, opening: Opening, *, recording: bool) -> tuple[int, int]:
        """One turn; a code of `step_kernels`, and the step of the turn where it ended. Taps only where recording."""
        starts = self._part_starts(turn)
        middles = 0.5 * (starts[:-1] + starts[1:] - 1) * self.stepper.dt
        speeds = self.rotation.speed(middles)
        parts = self.following.at(speeds, self.rotation.acceleration(middles))
        theta, width = self._tables(turn, int(starts[0]), int(starts[-1]), opening)
        section = self._time_of(turn) / self.stepper.dt - starts[0]
        results: list[TurnResult] = []
        arrivals: list[FloatArray] = []
        frames: list[TurnFrames] = []
        self.touches = []
        code, step = OK, 0
        ends = (starts - starts[0]).tolist()
        self._take_frames(len(ends) - 1)
        for start, end, speed, part in zip(ends[:-1], ends[1:], speeds, parts, strict=True):
            rows = slice(start, end + 2)
            self.stepper.follow(part, float(speed), np.roll(theta[rows], -1), float(section))
            self.opening = width[rows] + self.following.mean_growth(speed)
            code, done, ended = self.stepper.run_turn(self.opening, int(starts[0]) + start, recording=recording)
            arrivals.append(_arrivals(self.stepper))
            results.append(_copied(self.stepper.result))
            frames.append(_frames(self.stepper.result, int(starts[0]) + start, end - start))
            if start == 0:
                self.tip_growth = part.tips.static.T.copy()
            self.touches.append(self.stepper.touches.ended[:ended].copy())
            section, step = 0.0, start + done
            if code != OK:
                break
        self.result, self.arrivals = _joined(results), np.concatenate(arrivals)
        self.frames = TurnFrames(*(np.concatenate(columns) for columns in zip(*frames, strict=True)))
        return code, step

    def _take_frames(self, parts: int) -> None:
        """Ask each of so many parts of a turn for its share of the frames."""
        wanted, result = -(-FRAMES // parts), self.stepper.result
        if len(result.frames) != wanted:
            self.stepper.result = result._replace(frames=np.zeros((wanted, result.frames.shape[1])))

    def _tables(self, turn: int, first: int, last: int, opening: Opening) -> tuple[FloatArray, FloatArray]:
        """Theta at the steps first - 1, ..., last of a turn, and the surface's opening less the tips' growth."""
        time = np.arange(first - 1, last + 1) * self.stepper.dt
        theta = self.rotation.angle(time) - 2 * np.pi * (turn - self.settle)
        growth = self.following.mean_growth(self.rotation.speed(time))
        return theta, opening(turn + theta / (2 * np.pi)) - growth

    def _time_of(self, turn: int) -> float:
        return self.rotation.time_of(2 * math.pi * (turn - self.settle))

    def _part_starts(self, turn: int) -> IntArray:
        """First step of each part of a turn, and of the next turn."""
        first, last = self.first_step(turn), self.first_step(turn + 1)
        times = np.linspace(first, last, 9) * self.stepper.dt
        rate = np.abs(self.rotation.acceleration(times) / self.rotation.speed(times)).max()
        parts = min(max(1, math.ceil(rate * (times[-1] - times[0]) / SPEED_SHARE)), MOST_PARTS)
        starts = np.rint(np.linspace(first, last, parts + 1)).astype(np.int64)
        corner = round(self.rotation.seconds / self.stepper.dt)  # where the ramp ends
        return np.union1d(starts, [corner]) if first < corner < last else starts


def _frames(result: TurnResult, first: int, steps: int) -> TurnFrames:
    """The frames of a turn or part of so many steps from number `first` on; see `turn_kernels.record_frame`."""
    count = min(len(result.frames), steps)
    number = np.arange(count)
    even = -(-number * steps // len(result.frames))
    return TurnFrames(first + np.maximum(even, number), result.frames[:count].copy())


def _copied(result: TurnResult) -> TurnResult:
    """A part's result, safe from the next one; its taps are its own already."""
    return result._replace(section=result.section.copy(), summary=result.summary.copy(), orbit=result.orbit.copy())


def _arrivals(stepper: Stepper) -> FloatArray:
    """Arrivals under timing probes in what was just run."""
    return stepper.taps.timing.arrivals[: int(stepper.result.summary[3])].copy()


def _joined(parts: list[TurnResult]) -> TurnResult:
    """The result of a turn from those of its parts."""
    taps = np.concatenate([part.taps for part in parts], axis=1)
    summary = np.sum([part.summary for part in parts], axis=0)
    summary[2] = max(part.summary[2] for part in parts)
    orbit = np.sum([part.orbit for part in parts], axis=0)
    return parts[0]._replace(taps=taps, summary=summary, orbit=orbit)
