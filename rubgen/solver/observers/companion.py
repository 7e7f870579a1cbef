"""Run a companion trajectory beside the run. The growth of their distance is the largest Lyapunov exponent."""

import math
from typing import Any

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.contact.liner_kernels import REMOVED
from rubgen.errors import UserError
from rubgen.solver.exponent import ASKED_FROM, is_settled
from rubgen.solver.observers.companion_kernels import distance, run_companion
from rubgen.solver.observers.observer import Observer
from rubgen.solver.scheme.model import new_state
from rubgen.solver.scheme.motion_kernels import recover
from rubgen.solver.scheme.state_kernels import OK
from rubgen.solver.scheme.stepper import Stepper
from rubgen.solver.speed.turn import Turn

PIECES = 16
"""Renormalisations in a turn."""
CLOSENESS = 1e-8
"""Distance of the companion over the size of the motion: a thousandth of what a tip enters in one step of a touch, a
million times the rounding of a step."""
LEAST_TURNS = 32
"""The least number of turns of a meaningful exponent."""


def check_turns(record_turns: int) -> None:
    """Raise UserError if a record of `record_turns` turns is too short for a Lyapunov exponent."""
    if record_turns < LEAST_TURNS:
        raise UserError(
            f"record_turns = {record_turns}: a Lyapunov exponent needs at least {LEAST_TURNS} turns, reliably 500; "
            "raise it, or switch the exponent off (labels.lyapunov = false)"
        )


def piece_ends(steps: int) -> list[int]:
    """Return the numbers of the steps at which the pieces of a turn of `steps` steps end, as equal as possible.

    There are 16 pieces, or `steps` if that is less.
    """
    pieces = min(PIECES, steps)
    return [round(steps * piece / pieces) for piece in range(1, pieces + 1)]


class CompanionGrowth(Observer):
    """Measures the growth of a companion's distance in each turn of a record.

    With `stops` the companion stops once its exponent `is_settled`; the run goes on without it. The stepper must take
    snapshots at `piece_ends` of a turn.
    """

    def __init__(self, stepper: Stepper, *, stops: bool) -> None:
        self.stepper, self.stops, self.growth = stepper, stops, list[float]()
        self.companion: Companion | None = None
        self.removed = 0.0

    def start(self) -> None:
        """Start the companion beside the run."""
        self.companion, self.removed = Companion(self.stepper), self.stepper.state.wear.sums[REMOVED]

    def turn(self, turn: Turn) -> None:
        """Run the companion through the turn, and append ln of the growth of its distance to `growth`.

        Nothing is done before `start` and after the companion has stopped. The growth is NaN if the companion failed,
        or if the surface has worn in the turn: the companion's surface then differs from the run's.
        """
        before, self.removed = self.removed, self.stepper.state.wear.sums[REMOVED]
        if self.companion is None:
            return
        same_surface = self.removed == before
        self.growth.append(float(self.companion.run_turn(turn.opening).sum()) if same_surface else math.nan)
        if self.stops and is_settled(self.growth):
            self.companion = None

    def result(self) -> dict[str, Any]:
        """Return the field `companion_growth` (turns,), ln of the growth in each turn of the companion."""
        return {"companion_growth": np.array(self.growth)}


class DecayGrowth(Observer):
    """The growth of a companion's distance for a motion that never touches.

    In every turn ln of the distance falls by `decay_per_turn`, the slowest decay times the duration of a turn. `record`
    is the number of turns of the record.
    """

    def __init__(self, decay_per_turn: float, record: int) -> None:
        growth = np.full(record, -decay_per_turn)
        settled = record >= ASKED_FROM and is_settled(growth[:ASKED_FROM].tolist())
        self.growth = growth[:ASKED_FROM] if settled else growth

    def result(self) -> dict[str, Any]:
        """Return the field `companion_growth` (turns,), for as many turns as a companion that stops would have run."""
        return {"companion_growth": self.growth}


class Companion:
    """A second trajectory of the same model, which starts near the present state of `stepper`.

    All its coordinates are displaced a little. Call `run_turn` after each turn of the stepper, which must take
    snapshots. The stepper's own bits do not change. The distance is the energy norm sqrt(d_v^T M d_v + Omega^2 d_q^T M
    d_q), independent of the choice of coordinates. Any other norm has the same exponent in the long run.
    """

    def __init__(self, stepper: Stepper) -> None:
        self.stepper, self.state = stepper, new_state(stepper.model)
        self.state.contact.step_gaps[:] = stepper.state.contact.step_gaps
        before, now, _ = stepper.state.motions
        main, still = np.stack([before.z, now.z]), np.zeros((2, now.z.size))
        self.closeness = CLOSENESS * (self._distance(main, still) or 1.0)
        start = main + self._away(stepper)
        start = main + (start - main) * (self.closeness / self._distance(main, start))
        for motion, z in zip(self.state.motions, start, strict=False):
            motion.z[:] = z
            recover(stepper.model.harmonics, motion, self.state.scratch.share)

    def run_turn(self, opening: FloatArray) -> FloatArray:
        """Run the companion through the last turn.

        Return ln of the growth of the distance in each piece between snapshots. All values are NaN where the companion
        failed. `opening` (steps + 2,) is added to the radius of the surface, m.
        """
        stepper, growth = self.stepper, np.full(len(self.stepper.snapshots.steps), np.nan)
        self.state.wear.depth[:] = stepper.state.wear.depth
        code = run_companion(stepper.model, opening, stepper.snapshots, self.closeness, self.state, growth)
        return growth if code == OK else np.full(growth.size, np.nan)

    def _distance(self, main: FloatArray, companion: FloatArray) -> float:
        model, motions = self.stepper.model, self.state.motions[:2]
        for motion, z in zip(motions, companion, strict=True):
            motion.z[:] = z
        return float(distance(model.laws, model.energy.M, main, motions, self.state.scratch))

    @staticmethod
    def _away(stepper: Stepper) -> FloatArray:
        """Return a direction with a share of every mode: displacements and Omega times as large velocities."""
        phase = 1.0 + np.arange(stepper.system.M.shape[0]) ** 2
        now, speed = np.cos(phase), stepper.system.speed * np.sin(phase)
        return 1e-9 * np.stack([stepper.blocks.to_z(now - stepper.dt * speed), stepper.blocks.to_z(now)])
