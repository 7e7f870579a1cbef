"""The protocol of all that is kept of a run."""

from __future__ import annotations

from typing import Any, Protocol

from rubgen.solver.speed.turn import Turn


class Observer(Protocol):
    """Keeps something of a run. It changes nothing in the motion, and its memory does not grow with the steps.

    A new one is a file here, and a line in `observers.chosen`.
    """

    def start(self) -> None:
        """The record begins with the next turn."""
        ...

    def turn(self, turn: Turn) -> None:
        """Take a turn that was just run, of the settling (`turn.number` < 0) or of the record."""
        ...

    def result(self) -> dict[str, Any]:
        """The fields of `Response` that it fills, by name."""
        ...
