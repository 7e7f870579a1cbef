"""The base class of all observers of a run."""

from abc import ABC, abstractmethod
from typing import Any

from rubgen.solver.speed.turn import Turn


class Observer(ABC):
    """Records something of a run. It never changes the motion, and its memory does not grow with the steps.

    A new observer is a file here and a line in `observers.chosen`.
    """

    def start(self) -> None:  # noqa: B027
        """Prepare for the record, which begins with the next turn. Does nothing by default."""

    def turn(self, turn: Turn) -> None:  # noqa: B027
        """Take in a turn that was just run, of the settling (`number` < 0) or the record. Does nothing by default."""

    @abstractmethod
    def result(self) -> dict[str, Any]:
        """Return the fields of `Response` that this observer makes, by name."""
