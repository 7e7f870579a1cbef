"""Figure 18: contact at two stiffnesses of the disk's support."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from validation.piece import Found, Piece
from validation.zeng2019.drawing.contact_figure import contact_figure
from validation.zeng2019.figures.figure16 import zones_and_motion
from validation.zeng2019.runs.cases import NAMED_DISK_SUPPORTS, disk_sweep, on_disk_support, outcomes
from validation.zeng2019.runs.measures import rubbing
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import Statement, power

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def pieces(size: Size) -> Sequence[Piece]:
    """The sweep and the two named values."""
    return [*disk_sweep(size).values(), *(on_disk_support(size, k) for k in NAMED_DISK_SUPPORTS)]


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """Zones and motion over the sweep."""
    return zones_and_motion(list(rubbing(outcomes(disk_sweep(size), found)).values()))


def figures(size: Size, found: Found) -> dict[str, Figure]:
    """The two named values."""
    named = outcomes({k: on_disk_support(size, k) for k in NAMED_DISK_SUPPORTS}, found)
    caption = "Impulse of the last 49 turns by place (blue) and by blade (red), on the disk supports named in the paper"
    return {caption: contact_figure({f"{power(k)} N/m": run for k, run in named.items()})}


SECTION = Section(
    name="18",
    title="Figure 18: contact on two disk supports",
    text="Statements are judged over every rubbing run of the sweep of the disk's support.",
    pieces=pieces,
    statements=statements,
    figures=figures,
    compared=True,
)
