"""Draw mode shapes of a machine at rest: the first ones, or those that are chosen by number, family or diameters."""

import re
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rubgen.arrays import FloatArray
from rubgen.errors import NoPictureError
from rubgen.reduction import ReducedModel
from rubgen.reduction.modes import blisk_modes, casing_diameters
from rubgen.viz.colors import BLUE, GREY, VERMILION
from rubgen.viz.figures.style import INK, new_figure

COLUMNS = 6
MOST = 24
"""More shapes than these would be too small to see."""
DRAWN = 0.18
"""Largest drawn displacement over the radius."""
DIRECTIONS = ("radial", "tangential", "axial")
CASING = "casing"
ASKED = re.compile(r"(?P<family>(?!nd )[a-z]+(?: \d+)?)? ?(?:nd (?P<diameters>\d+))?")


@dataclass(frozen=True, kw_only=True)
class _Shape:
    """A mode: its number in the list of its part, from 1, what it is called, and the displaced ring, of radius 1."""

    number: int
    family: str
    diameters: int
    title: str
    moved: FloatArray

    @property
    def color(self) -> str:
        return BLUE if self.family == CASING else VERMILION


def mode_shapes(model: ReducedModel, modes: str | None = None) -> Figure:
    """Draw mode shapes at rest, without damping: tips of the blisk, or the casing.

    The points are displaced outward by the mode's largest component. The component is named, with the nodal diameters
    (ND) of the mode. `modes` chooses by commas: `7` is mode 7 of the blisk in the list of `rubgen modes`, `casing 3`
    mode 3 of the casing, `blade 1` a family, `ND 2` all modes of two nodal diameters, `blade 1 ND 2` or `casing ND 2`
    both. For None the first six of the casing and of the blisk are drawn. At most 24 modes are drawn. Raises ValueError
    where no mode meets a choice.
    """
    blisk, casing = _blisk_shapes(model), _casing_shapes(model)
    shapes = casing[:COLUMNS] + blisk[:COLUMNS] if modes is None else _chosen(blisk, casing, modes)
    drawn = shapes[:MOST]
    rows = -(-len(drawn) // COLUMNS)
    columns = min(len(drawn), COLUMNS)
    figure = new_figure(max(1.7 * columns, 4.5), 0.5 + 1.95 * rows)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes in panels[len(drawn) :]:
        axes.axis("off")
    for axes, shape in zip(panels, drawn, strict=False):
        _ring(axes, shape)
    what = "first modes" if modes is None else f"modes {modes}"
    cut = f", the first {MOST} of {len(shapes)}" if len(shapes) > MOST else ""
    figure.suptitle(f"{model.machine.name}: {what} at rest{cut}", fontsize=11, color=INK)
    return figure


def _blisk_shapes(model: ReducedModel) -> list[_Shape]:
    squares, vectors = model.modes_at_rest()
    blades = model.machine.blades.count
    shapes = []
    for number, (square, vector, mode) in enumerate(zip(squares, vectors.T, blisk_modes(model, 0.0), strict=True), 1):
        tips = vector[: 3 * blades].reshape(blades, 3)
        direction = int(np.argmax(np.abs(tips).max(axis=0)))
        hertz = float(np.sqrt(max(square, 0.0)) / (2 * np.pi))
        title = f"{number}: {hertz:.1f} Hz, {mode.family}\n{DIRECTIONS[direction]}, ND {mode.nodal_diameters}"
        moved = _unit_ring(blades) * (tips[:, direction] / np.abs(tips).max())[:, None]
        shapes.append(
            _Shape(number=number, family=mode.family, diameters=mode.nodal_diameters, title=title, moved=moved)
        )
    return shapes


def _casing_shapes(model: ReducedModel) -> list[_Shape]:
    table = zip(
        model.casing_frequencies_hz, casing_diameters(model), np.moveaxis(model.casing.modes_xy, -1, 0), strict=True
    )
    return [
        _Shape(
            number=number, family=CASING, diameters=waves, moved=shape / np.abs(shape).max(),
            title=f"casing {number}: {hertz:.1f} Hz\nND {waves}",
        )
        for number, (hertz, waves, shape) in enumerate(table, 1)
    ]  # fmt: skip


def _chosen(blisk: list[_Shape], casing: list[_Shape], text: str) -> list[_Shape]:
    """Return the shapes that the choices of `text` name, each once, in the order of the choices."""
    found: dict[tuple[bool, int], _Shape] = {}
    for choice in text.split(","):
        met = _matching(blisk, casing, choice)
        if not met:
            families = ", ".join(dict.fromkeys(shape.family for shape in blisk + casing))
            raise NoPictureError(
                f"--modes {choice.strip()!r}: no such mode; give a number from 1 to {len(blisk)}, "
                f"a family ({families}), 'ND 2', or a family with its diameters such as 'blade 1 ND 2'"
            )
        found |= {(shape.family == CASING, shape.number): shape for shape in met}
    return list(found.values())


def _matching(blisk: list[_Shape], casing: list[_Shape], choice: str) -> list[_Shape]:
    words = " ".join(choice.lower().split())
    if words.isdecimal():
        return [shape for shape in blisk if shape.number == int(words)]
    if numbered := re.fullmatch(rf"{CASING} (\d+)", words):
        return [shape for shape in casing if shape.number == int(numbered[1])]
    asked = ASKED.fullmatch(words)
    if not words or asked is None:
        return []
    family, diameters = asked["family"], asked["diameters"]
    return [
        shape
        for shape in (casing if family == CASING else blisk)
        if family in (None, shape.family) and diameters in (None, str(shape.diameters))
    ]


def _unit_ring(count: int) -> FloatArray:
    angle = 2 * np.pi * np.arange(count) / count
    return np.column_stack([np.cos(angle), np.sin(angle)])


def _ring(axes: Axes, shape: _Shape) -> None:
    ring = _unit_ring(len(shape.moved))
    drawn = ring + DRAWN * shape.moved
    axes.plot(*np.vstack([ring, ring[:1]]).T, color=GREY, linewidth=0.8)
    axes.plot(*np.vstack([drawn, drawn[:1]]).T, ".-", color=shape.color, linewidth=1.4, markersize=2.5)
    axes.set(xlim=(-1.3, 1.3), ylim=(-1.3, 1.3), aspect="equal")
    axes.set_title(shape.title, fontsize=8.5)
    axes.axis("off")
