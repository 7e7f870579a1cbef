"""Run a motion that provably never touches: one turn of the exact rub-free motion, repeated again and again."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rubgen.solver.scheme.stepper import Stepper
from rubgen.solver.scheme.turn_kernels import TurnResult
from rubgen.solver.speed.driver import Opening, SteadyDriver
from rubgen.solver.speed.turn import Turn, TurnFrames


class RepeatedDriver(SteadyDriver):
    """A constant speed at which a stepper in its rub-free motion never touches: it integrates one turn, and repeats it.

    A turn that is recorded while the clearance still closes is integrated. `decay` in 1/s is the slowest decay of the
    system, the rate at which a companion trajectory approaches the run.
    """

    def __init__(self, stepper: Stepper, settle: int, decay: float) -> None:
        super().__init__(stepper, settle)
        self.decay = decay
        self.once: Turn | None = None
        self.integrated, self.repeated = 0, 0

    @property
    def times(self) -> float:
        """Turns of the run for each turn that was integrated. Multiply the stepper's works (J) by this number."""
        return (self.integrated + self.repeated) / self.integrated

    def run_turns(self, numbers: range, opening: Opening, *, recording: bool) -> Iterator[Turn]:
        """Yield the turns with these numbers. One integrated turn is repeated under each number.

        A recorded turn in which `opening` is not yet 0 is integrated itself. Of settling turns that are not recorded
        only the first is yielded: the others are that turn once more, and nobody reads them.
        """
        for number in numbers:
            if number < 0 and self.once is not None and not recording:
                self.repeated += 1
            else:
                yield self._run_turn(number, opening, recording=recording)

    def _run_turn(self, number: int, opening: Opening, *, recording: bool) -> Turn:
        if recording and opening(np.array([float(number + self.settle)]))[0] > 0:
            return self._integrated(number, opening)
        if self.once is None:
            turn = self._integrated(number, np.zeros_like)
            self.once = replace(turn, result=TurnResult(*(part.copy() for part in turn.result)))
            return replace(self.once, recording=recording)
        self.repeated += 1
        once, first = self.once, self.first_step(number)
        shift = first - once.first_step
        arrivals = once.arrivals.copy()
        arrivals[:, 2] += shift
        return replace(
            once,
            number=number,
            first_step=first,
            end_step=first + self.stepper.steps,
            recording=recording,
            arrivals=arrivals,
            frames=TurnFrames(once.frames.step + shift, once.frames.z),
        )

    def _integrated(self, number: int, opening: Opening) -> Turn:
        self.integrated += 1
        return next(super().run_turns(range(number, number + 1), opening, recording=True))
