"""One figure or group of statements: what it needs, what it says, what it shows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from validation.piece import Found, Piece
from validation.zeng2019.size import Size
from validation.zeng2019.statement import Statement

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True)
class Section:
    """What belongs to one figure of the paper (`name` is its number) or to one of its conclusions.

    `also` are numbers of further figures that it covers. `pieces`, `statements` and `figures` are functions of the
    size; the latter two read the pieces that were made. The keys of `figures` are captions. `text` stands above them.
    `compared` sections are judged with all MACHINES, the others with the preset alone.
    """

    name: str
    title: str
    text: str
    pieces: Callable[[Size], Sequence[Piece]]
    statements: Callable[[Size, Found], Sequence[Statement]]
    figures: Callable[[Size, Found], dict[str, Figure]]
    also: tuple[str, ...] = ()
    compared: bool = False

    @property
    def command(self) -> str:
        """What repeats this section alone."""
        return f"python -m validation.zeng2019 --figure {self.name}"


def no_figures(_size: Size, _found: Found) -> dict[str, Figure]:
    """For a section that shows nothing."""
    return {}
