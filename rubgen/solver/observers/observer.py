"""What all observers of a run have."""

from abc import ABC, abstractmethod
from typing import Any

from rubgen.solver.speed.turn import Turn


class Observer(ABC):
    """Records something of a run. It never changes the motion, and its memory does not grow with the steps.

    A new observer is a file here and a line in `observers.chosen`.
    """

    def start(self) -> None:  # noqa: B027
        """Called once: the record begins with the next turn. Does nothing by default."""

    def turn(self, turn: Turn) -> None:  # noqa: B027
        """Called after each turn, of the settling (`turn.number` < 0) or of the record. Does nothing by default."""

    @abstractmethod
    def result(self) -> dict[str, Any]:
        """The fields of `Response` from this observer, by name."""
