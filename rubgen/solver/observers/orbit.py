"""Keep the means of the disk centre's motion."""

from collections import deque
from typing import Any

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.solver.observers.observer import Observer
from rubgen.solver.speed.turn import Turn


class Orbit(Observer):
    """Keeps the means of the disk centre's orbit over each of the last `turns` turns of the record; None is all."""

    def __init__(self, turns: int | None) -> None:
        self.means: deque[FloatArray] = deque(maxlen=turns)

    def turn(self, turn: Turn) -> None:
        """Keep the means of a turn."""
        if turn.number >= 0 and turn.recording:
            self.means.append(turn.result.orbit / turn.result.taps.shape[1])

    def result(self) -> dict[str, Any]:
        """Return the field `orbit` (turns, 5)."""
        return {"orbit": np.array(self.means).reshape(-1, 5)}
