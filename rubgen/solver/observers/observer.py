"""The base class of all observers of a run."""

from abc import ABC, abstractmethod
from typing import Any

from rubgen.solver.speed.turn import Turn


class Observer(ABC):
    """Records a part of a response.

    It never changes the motion, and does not keep the state of every step.
    """

    def start(self) -> None:  # noqa: B027
        """Prepare for the record, which begins with the next turn. Does nothing by default."""

    def turn(self, turn: Turn) -> None:  # noqa: B027
        """Read the turn that was just run: of the settling (`number` < 0) or of the record. Does nothing by default."""

    @abstractmethod
    def result(self) -> dict[str, Any]:
        """Return fields of `Response` by name: the values that this observer has recorded."""
