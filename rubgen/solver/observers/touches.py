"""Keep the touches of blades."""

from typing import Any

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.solver.observers.observer import Observer
from rubgen.solver.response import ContactEvents
from rubgen.solver.scheme.stepper import Stepper
from rubgen.solver.scheme.turn_kernels import BLADE, COSINE, FRICTION_LOSS, IMPULSE, NORMAL_LOSS, SINE, START, STEPS
from rubgen.solver.speed.turn import Turn


class TouchKeeper(Observer):
    """Keeps the touches of a record of `record` turns."""

    def __init__(self, stepper: Stepper, record: int) -> None:
        self.stepper, self.record = stepper, record
        self.touches: list[FloatArray] = []

    def start(self) -> None:
        """Count only the steps from the start of the record for a touch that is present there."""
        self.stepper.begin_record()

    def turn(self, turn: Turn) -> None:
        """Add the touches that ended in a turn; after the last turn, the present touches too."""
        if turn.number >= 0:
            self.touches += turn.touches
        if turn.number == self.record - 1:
            self.touches.append(self.stepper.end_record(turn.end_step))

    def result(self) -> dict[str, Any]:
        """Return the field `events`, the touches as `ContactEvents`."""
        return {"events": contact_events(self.touches)}


def contact_events(touches: list[FloatArray]) -> ContactEvents:
    """Sort touches by their last step, then by blade, and return them as `ContactEvents`.

    Each array of `touches` is (touches, 8), one row for each touch: number of the blade, first step, number of steps,
    sums of impulse times cosine and sine of the polar angle, impulse (N s), friction loss and normal loss (J). An empty
    list makes empty events.
    """
    rows = np.concatenate([np.zeros((0, 8)), *touches])
    rows = rows[np.lexsort((rows[:, BLADE], rows[:, START] + rows[:, STEPS]))]
    angle = np.mod(np.arctan2(rows[:, SINE], rows[:, COSINE]), 2 * np.pi)
    return ContactEvents(
        blade=rows[:, BLADE].astype(np.int64),
        start_step=rows[:, START].astype(np.int64),
        steps=rows[:, STEPS].astype(np.int64),
        angle=np.where(angle < 2 * np.pi, angle, 0.0),  # a tiny negative angle rounds up to the whole turn
        impulse=rows[:, IMPULSE].copy(),
        friction_loss=rows[:, FRICTION_LOSS].copy(),
        normal_loss=rows[:, NORMAL_LOSS].copy(),
    )
