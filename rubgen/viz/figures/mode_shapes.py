"""Shapes of the first modes: the casing's ring, and the ring of the blade tips."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.linalg import eigh

from rubgen.arrays import FloatArray
from rubgen.reduction import ReducedModel
from rubgen.viz.colors import BLUE, GREY, VERMILION
from rubgen.viz.figures.style import new_figure

SHOWN = 6
DRAWN = 0.18
"""The largest displacement over the radius."""
DIRECTIONS = ("radial", "tangential", "axial")


def mode_shapes(model: ReducedModel) -> Figure:
    """The first modes at rest: casing above; below the tips, moved outward by their largest component.

    The component that is drawn is named, and its nodal diameters (ND). The tips' rings come from
    the reduced model, without damping.
    """
    figure = new_figure(10.0, 4.4)
    rows = figure.subplots(2, SHOWN)
    for mode, axes in enumerate(rows[0]):
        shape = model.casing.modes_xy[..., mode]
        hertz = model.casing_frequencies_hz[mode]
        _ring(axes, _unit_ring(len(shape)), shape / np.abs(shape).max(), f"casing {mode + 1}: {hertz:.1f} Hz", BLUE)
    squares, vectors = eigh(model.stiffness(0.0), model.blisk.M)
    blades = model.machine.blades.count
    for mode, axes in enumerate(rows[1]):
        tips = vectors[: 3 * blades, mode].reshape(blades, 3)
        direction = int(np.argmax(np.abs(tips).max(axis=0)))
        ring = _unit_ring(blades)
        moved = ring * (tips[:, direction] / np.abs(tips).max())[:, None]
        hertz = float(np.sqrt(max(squares[mode], 0.0)) / (2 * np.pi))
        title = f"blisk {mode + 1}: {hertz:.1f} Hz\n{DIRECTIONS[direction]}, {_diameters(tips[:, direction])}"
        _ring(axes, ring, moved, title, VERMILION)
    return figure


def _unit_ring(count: int) -> FloatArray:
    angle = 2 * np.pi * np.arange(count) / count
    return np.column_stack([np.cos(angle), np.sin(angle)])


def _diameters(values: FloatArray) -> str:
    """The nodal diameters of values at equal angles."""
    return f"ND {int(np.argmax(np.abs(np.fft.rfft(values))))}"


def _ring(axes: Axes, ring: FloatArray, moved: FloatArray, title: str, color: str) -> None:
    closed = np.vstack([ring, ring[:1]])
    drawn = ring + DRAWN * moved
    axes.plot(*closed.T, color=GREY, linewidth=0.8)
    axes.plot(*np.vstack([drawn, drawn[:1]]).T, ".-", color=color, linewidth=1.4, markersize=2.5)
    axes.set(xlim=(-1.3, 1.3), ylim=(-1.3, 1.3), aspect="equal")
    axes.set_title(title, fontsize=8.5)
    axes.axis("off")
