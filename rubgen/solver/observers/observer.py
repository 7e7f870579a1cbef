"""The protocol of all observers of a run."""

from typing import Any, Protocol

from rubgen.solver.speed.turn import Turn


class Observer(Protocol):
    """Records something of a run. It never changes the motion, and its memory does not grow with the steps.

    A new observer is a file here and a line in `observers.chosen`.
    """

    def start(self) -> None:
        """Called once: the record begins with the next turn."""
        ...

    def turn(self, turn: Turn) -> None:
        """Called after each turn, of the settling (`turn.number` < 0) or of the record."""
        ...

    def result(self) -> dict[str, Any]:
        """The fields of `Response` from this observer, by name."""
        ...
