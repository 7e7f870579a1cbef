"""Run a stepper turn by turn: at a steady speed in one call a turn, at a changing speed in short parts."""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import lru_cache
from typing import Protocol

import numpy as np

from rubgen.arrays import FloatArray, IntArray
from rubgen.scenario.rotation import Rotation, steady_rotation
from rubgen.solver.linear.rub_free import RubFreeMotion
from rubgen.solver.scheme.state_kernels import OK
from rubgen.solver.scheme.stepper import FRAMES, TURNS, Stepper
from rubgen.solver.scheme.turn_kernels import TurnResult
from rubgen.solver.speed.interpolation import SpeedInterpolation
from rubgen.solver.speed.start import narrowed
from rubgen.solver.speed.turn import Turn, TurnFrames

SPEED_SHARE = 2e-4
"""Within a part the matrices are constant, at its middle speed. The speed changes by at most this share, if MOST_PARTS
parts of a turn are enough for that."""
MOST_PARTS = 64
MOST_STEPS_AT_ONCE = 4096
"""Turns of more steps are run one by one: entering the kernel is a small share of such a turn, and room for the touches
of several such turns is large."""
NEVER = 2**62
"""A step number that no part reaches."""

Opening = Callable[[FloatArray], FloatArray]
"""The opening of the surface, m, after a number of turns from the start: it is added to the radius of the surface."""


class SpeedDriver(Protocol):
    """Runs a stepper turn by turn. Turns and steps are counted from the start of the record."""

    stepper: Stepper
    settle: int
    """Turns before the record."""
    rotation: Rotation

    def first_step(self, number: int) -> int:
        """Return the number of the step at which a turn begins."""
        ...

    def run_turns(self, numbers: range, opening: Opening, *, recording: bool) -> Iterator[Turn]:
        """Run turns one after another. The stepper's outputs belong to the turn that was yielded last.

        - numbers: numbers of the turns; negative before the record.
        - opening: function of the turns since the start of the run (any,), also fractions; it returns the opening of
          the surface, m.
        - recording: whether taps, orbit and arrivals are recorded.

        A turn that fails is yielded too, with its code. No turn may be taken after it.
        """
        ...


class SteadyDriver:
    """A constant speed: every turn has the same steps. The record begins after `settle` turns."""

    def __init__(self, stepper: Stepper, settle: int) -> None:
        self.stepper, self.settle = stepper, settle
        self.rotation = steady_rotation(stepper.system.speed)
        self.places = np.arange(-1, stepper.steps + 1) / stepper.steps

    def first_step(self, number: int) -> int:
        """Return the number of the step at which a turn begins."""
        return number * self.stepper.steps

    def run_turns(self, numbers: range, opening: Opening, *, recording: bool) -> Iterator[Turn]:
        """Run turns, several in one call of the kernel; see `SpeedDriver.run_turns`."""
        at_once = self._at_once(recording=recording)
        for start in range(0, len(numbers), at_once):
            yield from self._run_together(numbers[start : start + at_once], opening, recording=recording)

    def _run_together(self, numbers: range, opening: Opening, *, recording: bool) -> Iterator[Turn]:
        stepper, steps = self.stepper, self.stepper.steps
        width = np.array([opening(number + self.settle + self.places) for number in numbers])
        stepper.grow_loads(*(self.first_step(number) * stepper.dt for number in (numbers[0], numbers[-1] + 1)))
        if stepper.system.narrowings:
            times = np.add.outer([self.first_step(number) for number in numbers], np.arange(-1, steps + 1)) * stepper.dt
            width -= narrowed(stepper.system, times)
        made = stepper.run_turns(width, self.first_step(numbers[0]), recording=recording)
        for number, wide, (code, step, ended) in zip(numbers, width, made, strict=False):
            first = self.first_step(number)
            yield Turn(
                number=number,
                code=code,
                step=step,
                first_step=first,
                end_step=first + steps,
                recording=recording,
                result=stepper.result,
                touches=[stepper.touches.ended[:ended].copy()],
                arrivals=_arrivals(stepper),
                opening=wide,
                frames=_frames(stepper.result, first, steps),
                tip_growth=stepper.system.tip_static,
            )

    def _at_once(self, *, recording: bool) -> int:
        """Return the number of turns in a call.

        It is one where every turn has arrivals, a worn surface or loads of its own, or many steps.
        """
        model, probes = self.stepper.model, len(self.stepper.taps.timing.angle)
        own = model.surface.liner.bins or len(model.support.growing) or (recording and probes)
        return 1 if own or self.stepper.steps > MOST_STEPS_AT_ONCE else TURNS


class ChangingDriver:
    """A speed that follows a rotation. At t = 0 theta is 0 and the record begins, after `settle` turns.

    Time steps are equal. A turn begins at the step that is nearest to theta = 0 mod 2 pi. Each turn is cut into equal
    parts. In a part the speed changes by at most SPEED_SHARE, unless this takes more than MOST_PARTS parts: then there
    are MOST_PARTS. The end of the ramp also begins a part. The matrices of a part belong to the speed in its middle, so
    the error falls with the square of a part's length. The tips' mean steady growth is exact at every step: its change
    within a part is subtracted from the opening, the length that is added to the surface's radius.
    """

    def __init__(self, stepper: Stepper, matrices: SpeedInterpolation, rotation: Rotation, settle: int) -> None:
        self.stepper, self.matrices, self.rotation, self.settle = stepper, matrices, rotation, settle
        stepper.take_snapshots([NEVER])

    def begin(self, motion: RubFreeMotion) -> None:
        """Put the stepper at the start of the settle turns, in a rub-free motion.

        `motion` belongs to `rotation.start`: the speed there, or the mean of a fluctuating speed. The stepper's works
        are set to zero, except for the works of the supports.
        """
        start = np.array([self._time_of(-self.settle)])
        speed = self.rotation.speed(start)
        part = next(self.matrices.at(speed, self.rotation.acceleration(start)))
        self.stepper.follow(part, float(speed[0]), np.zeros(3), 0.0)
        first = self.first_step(-self.settle)
        angles = self.rotation.angle((first + np.array([-1, 0])) * self.stepper.dt)
        self.stepper.set_coordinates(*(motion.at(angle) for angle in angles.tolist()))
        self.stepper.clear_works()

    def first_step(self, number: int) -> int:
        """Return the number of the step at which a turn begins."""
        return round(self._time_of(number) / self.stepper.dt)

    def run_turns(self, numbers: range, opening: Opening, *, recording: bool) -> Iterator[Turn]:
        """Run turns, see `SpeedDriver.run_turns`."""
        for number in numbers:
            yield self._run_turn(number, opening, recording=recording)

    def _run_turn(self, number: int, opening: Opening, *, recording: bool) -> Turn:
        stepper, starts = self.stepper, self._part_starts(number)
        first, ends = int(starts[0]), (starts - starts[0]).tolist()
        middles = 0.5 * (starts[:-1] + starts[1:] - 1) * stepper.dt
        speeds = self.rotation.speed(middles)
        parts = self.matrices.at(speeds, self.rotation.acceleration(middles))
        theta, width = self._tables(number, first, int(starts[-1]), opening)
        section = self._time_of(number) / stepper.dt - starts[0]
        stepper.take_frames(-(-FRAMES // (len(ends) - 1)))
        done: list[Turn] = []
        for start, end, speed, part in zip(ends[:-1], ends[1:], speeds, parts, strict=True):
            rows = slice(start, end + 2)
            stepper.follow(part, float(speed), np.roll(theta[rows], -1), float(section))
            stepper.grow_loads((first + start) * stepper.dt, (first + end) * stepper.dt)
            wide = width[rows] + self.matrices.mean_growth(speed)
            code, step, ended = stepper.run_turn(wide, first + start, recording=recording)
            done.append(
                Turn(
                    number=number,
                    code=code,
                    step=start + step,
                    first_step=first,
                    end_step=int(starts[-1]),
                    recording=recording,
                    result=_copied(stepper.result),
                    touches=[stepper.touches.ended[:ended].copy()],
                    arrivals=_arrivals(stepper),
                    opening=wide,
                    frames=_frames(stepper.result, first + start, end - start),
                    tip_growth=part.tips.static.T.copy(),
                )
            )
            section = 0.0
            if code != OK:
                break
        return _joined(done)

    def _tables(self, number: int, first: int, last: int, opening: Opening) -> tuple[FloatArray, FloatArray]:
        """Return theta at the steps first - 1, ..., last of a turn, and the surface's opening less the tips' growth."""
        time = np.arange(first - 1, last + 1) * self.stepper.dt
        theta = self.rotation.angle(time) - 2 * np.pi * number
        growth = self.matrices.mean_growth(self.rotation.speed(time))
        if self.stepper.system.narrowings:
            growth += narrowed(self.stepper.system, np.asarray(time, dtype=np.float64))
        return theta, opening(number + self.settle + theta / (2 * np.pi)) - growth

    def _time_of(self, number: int) -> float:
        return self.rotation.time_of(2 * math.pi * number)

    def _part_starts(self, number: int) -> IntArray:
        """Return the first step of each part of a turn, and of the next turn."""
        first, last = self.first_step(number), self.first_step(number + 1)
        times = np.linspace(first, last, 9) * self.stepper.dt
        rate = np.abs(self.rotation.acceleration(times) / self.rotation.speed(times)).max()
        parts = min(max(1, math.ceil(rate * (times[-1] - times[0]) / SPEED_SHARE)), MOST_PARTS)
        starts = np.rint(np.linspace(first, last, parts + 1)).astype(np.int64)
        corner = round(self.rotation.seconds / self.stepper.dt)  # where the ramp ends
        return np.union1d(starts, [corner]) if first < corner < last else starts


def _frames(result: TurnResult, first: int, steps: int) -> TurnFrames:
    """Return the frames of a turn or part of so many steps from number `first` on; see `turn_kernels.record_frame`."""
    places = _frame_steps(len(result.frames), steps)
    return TurnFrames(first + places, result.frames[: len(places)])


@lru_cache(maxsize=16)
def _frame_steps(frames: int, steps: int) -> IntArray:
    """Return the steps of a turn or part that have frames."""
    number = np.arange(min(frames, steps))
    return np.maximum(-(-number * steps // frames), number)


def _copied(result: TurnResult) -> TurnResult:
    """Return a copy of a part's result that the next part does not overwrite. Its taps are new in every part."""
    return result._replace(section=result.section.copy(), summary=result.summary.copy(), orbit=result.orbit.copy())


def _arrivals(stepper: Stepper) -> FloatArray:
    """Return the arrivals under timing probes in what was just run."""
    return stepper.taps.timing.arrivals[: int(stepper.result.summary[3])].copy()


def _joined(parts: list[Turn]) -> Turn:
    """Join the parts of a turn into one."""
    results = [part.result for part in parts]
    summary = np.sum([result.summary for result in results], axis=0)
    summary[2] = max(result.summary[2] for result in results)
    result = results[0]._replace(
        taps=np.concatenate([result.taps for result in results], axis=1),
        summary=summary,
        orbit=np.sum([result.orbit for result in results], axis=0),
    )
    return replace(
        parts[0],
        code=parts[-1].code,
        step=parts[-1].step,
        opening=parts[-1].opening,
        result=result,
        touches=[touches for part in parts for touches in part.touches],
        arrivals=np.concatenate([part.arrivals for part in parts]),
        frames=TurnFrames(
            np.concatenate([part.frames.step for part in parts]), np.concatenate([part.frames.z for part in parts])
        ),
    )
