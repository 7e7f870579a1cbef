"""Figure 9: the eleven modes of the casing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rubgen.machine.published import CASING_HZ
from rubgen.viz.colors import BLUE, GREY, ORANGE
from validation.piece import Found, Piece
from validation.zeng2019.drawing.style import new_figure
from validation.zeng2019.models.mode_shapes import casing_shapes
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import UNKNOWABLE, Statement, by_deviation

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
            statement="The drawn shapes of the casing's eleven modes.",
            verdict=UNKNOWABLE,
            found="circumferential orders " + ", ".join(str(order) for order in modes["order"]),
            why="The scan contains the frequencies but not the drawings.",
        ),
    ]


def figures(_size: Size, found: Found) -> dict[str, Figure]:
    """Eleven rings, their displacement enlarged; some nodes show where they came from."""
    modes = found(SHAPES)
    nodes = modes["moved"].shape[2]
    angle = np.linspace(0, 2 * np.pi, nodes + 1)
    e_r, e_t = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    figure = new_figure(9.5, 3.8)
    panels = figure.subplots(2, 6).ravel()
    for axes, hz, order, moved in zip(panels, modes["hz"], modes["order"], modes["moved"], strict=False):
        radial, tangential = 0.3 * np.append(moved, moved[:, :1], axis=1) / np.abs(modes["moved"]).max()
        place = (1 + radial) * e_r + tangential * e_t
        axes.plot(*e_r, color=GREY, linewidth=0.6)
        axes.plot(*place, color=BLUE, linewidth=1)
        axes.plot(*np.stack([e_r, place], axis=1)[:, :, :: nodes // 18], color=ORANGE, linewidth=0.7)
        axes.set_aspect("equal")
        axes.set(xlim=(-1.4, 1.4), ylim=(-1.4, 1.4))
        axes.set_title(f"{hz:.2f} Hz\norder {order}", fontsize=8)
    for axes in panels:
        axes.set_axis_off()
    caption = (
        "Modes of the casing, with the order that leads in radial and tangential displacement; orange lines join some "
        "nodes with their places at rest"
    )
    return {caption: figure}


SECTION = Section(
    name="9",
    title="Figure 9: modes of the casing",
    text="The preset's casing was fitted to these frequencies. They determine only the ratio of its springs to its "
    "mass.",
    pieces=pieces,
    statements=statements,
    figures=figures,
)
