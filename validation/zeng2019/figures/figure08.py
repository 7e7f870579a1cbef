"""Figure 8: named modes of the blisk."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rubgen.machine.published import BLISK_HZ
from validation.piece import Found, Piece
from validation.zeng2019.drawing.style import new_figure
from validation.zeng2019.figures.figure06 import KEPT, reduced
from validation.zeng2019.models.mode_shapes import drawn_modes
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import UNKNOWABLE, Statement, by_deviation

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NAMES = {
    1: "tilt, twice",
    3: "lateral, twice",
    5: "all blades together",
    39: "blades, one nodal diameter, twice",
    41: "axial",
    42: "torsion",
}
DRAWN = Piece(drawn_modes, (list(NAMES),))


def pieces(_size: Size) -> Sequence[Piece]:
    """Frequencies of the reduced model, shapes of the full one."""
    return [reduced(KEPT), DRAWN]


def statements(_size: Size, found: Found) -> Sequence[Statement]:
    """Six frequencies, all fitted, and the shapes."""
    hz = found(reduced(KEPT))["hz"]
    frequencies = [
        Statement(
            statement=f"Mode {mode}{f' and {mode + 1}' if 'twice' in name else ''}: {BLISK_HZ[mode]:.2f} Hz.",
            verdict=by_deviation(hz[mode - 1] / BLISK_HZ[mode] - 1),
            found=f"{hz[mode - 1]:.2f} Hz ({name})",
            used_for_fitting=True,
        )
        for mode, name in NAMES.items()
    ]
    shapes = Statement(
        statement="The drawn shapes of the blisk's six modes.",
        verdict=UNKNOWABLE,
        found="; ".join(f"{mode}: {name}" for mode, name in NAMES.items()),
        why="The scan contains the frequencies but not the drawings.",
    )
    return [*frequencies, shapes]


def figures(_size: Size, found: Found) -> dict[str, Figure]:
    """Six modes: places moved in the plane, shaded by displacement along the axis."""
    modes = found(DRAWN)
    xy, hz = modes["xy"], found(reduced(KEPT))["hz"]
    figure = new_figure(9.5, 6.4)
    for axes, number, moved in zip(figure.subplots(2, 3).ravel(), NAMES, modes["moved"], strict=True):
        place = 1e3 * (xy + 0.08 * moved[:, :2])
        axes.scatter(place[:, 0], place[:, 1], c=moved[:, 2], s=2, cmap="coolwarm", vmin=-1, vmax=1, linewidths=0)
        axes.set_aspect("equal")
        axes.set_axis_off()
        axes.set_title(f"{number}: {hz[number - 1]:.2f} Hz, {NAMES[number]}", fontsize=8)
        axes.set(xlim=(-470, 470), ylim=(-470, 470))
    return {"Modes of the blisk at rest; blue and red: displacement along the axis": figure}


SECTION = Section(
    name="8",
    title="Figure 8: modes of the blisk",
    text="The preset was fitted to these six frequencies, in the reduced model. So their agreement is no evidence for "
    "the geometry. Shapes are drawn from the full model.",
    pieces=pieces,
    statements=statements,
    figures=figures,
)
