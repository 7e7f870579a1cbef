"""Keep the state once a turn, and the impulse and number of steps with contact of each turn."""

from typing import Any

import numpy as np

from rubgen.solver.observers.observer import Observer
from rubgen.solver.speed.turn import Turn


class Sections(Observer):
    """Keeps the Poincare section, impulse and contact steps of each turn of a record.

    `record` is the number of turns, `size` the number of coordinates.
    """

    def __init__(self, record: int, size: int) -> None:
        self.section = np.zeros((record, 2, size))
        self.impulse = np.zeros(record)
        self.contact_steps = np.zeros(record, dtype=np.int64)

    def turn(self, turn: Turn) -> None:
        """Add section, impulse and number of steps with contact."""
        if turn.number >= 0:
            result, row = turn.result, turn.number
            self.section[row] = result.section
            self.impulse[row], self.contact_steps[row] = result.summary[0], int(result.summary[1])

    def result(self) -> dict[str, Any]:
        """Return the fields `section_q`, `section_v`, `impulse_per_turn`, `contact_steps_per_turn`."""
        return {
            "section_q": np.ascontiguousarray(self.section[:, 0]),
            "section_v": np.ascontiguousarray(self.section[:, 1]),
            "impulse_per_turn": self.impulse,
            "contact_steps_per_turn": self.contact_steps,
        }
