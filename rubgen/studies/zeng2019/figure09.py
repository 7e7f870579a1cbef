"""Figure 9: the eleven modes of the casing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rubgen.studies.published import CASING_HZ
from rubgen.studies.zeng2019.drawing import new_figure
from rubgen.studies.zeng2019.mode_shapes import casing_shapes
from rubgen.studies.zeng2019.piece import Found, Piece
from rubgen.studies.zeng2019.section import Section
from rubgen.studies.zeng2019.size import Size
from rubgen.studies.zeng2019.statement import UNKNOWABLE, Statement, by_deviation
from rubgen.viz.colors import BLUE, GREY

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHAPES = Piece(casing_shapes, (len(CASING_HZ),))


def pieces(_size: Size) -> Sequence[Piece]:
    """One: the casing's modes."""
    return [SHAPES]


def statements(_size: Size, found: Found) -> Sequence[Statement]:
    """The frequencies together, and the shapes."""
    modes = found(SHAPES)
    off = np.abs(modes["hz"] / np.array(CASING_HZ) - 1)
    return [
        Statement(
            statement=f"The casing's eleven frequencies, {CASING_HZ[0]} to {CASING_HZ[-1]} Hz.",
            verdict=by_deviation(float(off.max())),
            found=f"largest deviation {100 * off.max():.3f} %, of the mode {int(off.argmax()) + 1}",
            used_for_fitting=True,
        ),
        Statement(
            statement="The shapes of these modes.",
            verdict=UNKNOWABLE,
            found="circumferential orders " + ", ".join(str(order) for order in modes["order"]),
            why="The scan holds the frequencies and not the drawings.",
        ),
    ]


def figures(_size: Size, found: Found) -> dict[str, Figure]:
    """Eleven rings, their displacement enlarged."""
    modes = found(SHAPES)
    angle = np.linspace(0, 2 * np.pi, modes["radial"].shape[1] + 1)
    figure = new_figure(9.5, 3.6)
    panels = figure.subplots(2, 6).ravel()
    for axes, hz, order, radial in zip(panels, modes["hz"], modes["order"], modes["radial"], strict=False):
        ring = 1 + 0.25 * np.append(radial, radial[0]) / np.abs(modes["radial"]).max()
        axes.plot(np.cos(angle), np.sin(angle), color=GREY, linewidth=0.6)
        axes.plot(ring * np.cos(angle), ring * np.sin(angle), color=BLUE, linewidth=1)
        axes.set_aspect("equal")
        axes.set_title(f"{hz:.2f} Hz, order {order}", fontsize=8)
    for axes in panels:
        axes.set_axis_off()
    return {"Modes of the casing, radial displacement": figure}


SECTION = Section(
    name="9",
    title="Figure 9: modes of the casing",
    text="The preset's casing was fitted to these frequencies; only the ratio of its springs to its mass follows from "
    "them.",
    pieces=pieces,
    statements=statements,
    figures=figures,
)
