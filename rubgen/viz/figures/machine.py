"""Draw a machine: its natural frequencies over the speed with the exciting orders, and its first modes."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.linalg import eigh

from rubgen.arrays import FloatArray
from rubgen.reduction import ReducedModel
from rubgen.units import rad_per_s
from rubgen.viz.colors import BLUE, GREY, VERMILION
from rubgen.viz.figures.style import INK, label_axes, new_figure

HIGHEST_RPM, SPEEDS = 15_000.0, 121
BLISK_MODES, CASING_MODES = 12, 11
HIGHEST_ORDER = 8
SHOWN = 6
DRAWN = 0.18
"""Largest drawn displacement over the radius."""
DIRECTIONS = ("radial", "tangential", "axial")


def campbell(model: ReducedModel) -> Figure:
    """Draw Campbell diagrams of the blisk in its turning frame and of the casing in the inertial frame.

    In the turning frame the unbalance is static: the critical speed is where a frequency reaches zero. Anything fixed
    in the inertial frame rotates at -f_r there, so a casing of N lobes excites the blisk at orders kN. The blisk
    excites the casing likewise. Lines are without damping and without contact.
    """
    speeds = np.linspace(1.0, HIGHEST_RPM, SPEEDS)
    if model.critical_speed_rpm < HIGHEST_RPM:  # there a frequency is zero, in a corner that a grid would cut
        speeds = np.union1d(speeds, model.critical_speed_rpm)
    figure = new_figure(10.0, 5.0)
    blisk, casing = figure.subplots(1, 2)
    _blisk(blisk, model, speeds)
    _casing(casing, model, speeds)
    return figure


def _blisk(axes: Axes, model: ReducedModel, speeds: FloatArray) -> None:
    hertz = np.array([model.blisk_frequencies_hz(rad_per_s(speed))[:BLISK_MODES] for speed in speeds])
    top = 1.05 * float(hertz.max())
    _orders(axes, speeds, top, range(1, HIGHEST_ORDER + 1))
    axes.plot(speeds, hertz, color=BLUE, linewidth=1.1, zorder=3)
    critical = model.critical_speed_rpm
    if critical <= speeds[-1]:
        axes.axvline(critical, color=VERMILION, linewidth=1, linestyle="--")
        text = f"critical, {critical:,.0f} rev/min"
        axes.annotate(text, (critical, top), xytext=(3, -3), textcoords="offset points", color=VERMILION,
                      rotation=90, va="top", ha="left", fontsize=8, zorder=4,
                      bbox={"facecolor": "white", "edgecolor": "none", "pad": 1})  # fmt: skip
    _finish(axes, speeds, top, "Blisk: frequency in the turning frame, Hz")


def _casing(axes: Axes, model: ReducedModel, speeds: FloatArray) -> None:
    """Draw constant frequencies, with points where an order of the lobes crosses one of the casing's modes."""
    hertz = model.casing_frequencies_hz[:CASING_MODES]
    lobes = model.machine.casing.lobes
    top = 1.08 * float(hertz.max())
    orders = [lobes * k for k in range(1, max(HIGHEST_ORDER // lobes, 1) + 1)]
    _orders(axes, speeds, top, orders)
    axes.hlines(hertz, speeds[0], speeds[-1], color=BLUE, linewidth=1.1, zorder=3)
    met = np.array([(60 * f / order, f) for order in orders for f in hertz])
    met = met[met[:, 0] <= speeds[-1]]
    axes.plot(*met.T, "o", color=VERMILION, markersize=3.5, zorder=4)
    _finish(axes, speeds, top, "Casing: frequency, Hz")


def _orders(axes: Axes, speeds: FloatArray, top: float, orders: range | list[int]) -> None:
    """Draw lines k f_r, numbered where they leave the panel."""
    for order in orders:
        end = min(speeds[-1], 60 * top / order)
        axes.plot([0, end], [0, order * end / 60], color=GREY, linewidth=0.6, zorder=1)
        inside = end < speeds[-1]
        axes.annotate(
            f"{order}", (end, order * end / 60), xytext=(0, 2) if inside else (3, 0), textcoords="offset points",
            ha="center" if inside else "left", va="bottom" if inside else "center", fontsize=8, color=INK,
        )  # fmt: skip


def _finish(axes: Axes, speeds: FloatArray, top: float, text: str) -> None:
    axes.set(xlim=(0, speeds[-1]), ylim=(0, top))
    label_axes(axes, "Speed, rev/min (grey: orders of rotation)", text)


def mode_shapes(model: ReducedModel) -> Figure:
    """Draw the first modes at rest, casing above and tips below, displaced outward by their largest component.

    The drawn component is named, with its nodal diameters (ND). The tips come from the reduced model, without damping.
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
    """Return the nodal diameters of values at equal angles."""
    return f"ND {int(np.argmax(np.abs(np.fft.rfft(values))))}"


def _ring(axes: Axes, ring: FloatArray, moved: FloatArray, title: str, color: str) -> None:
    closed = np.vstack([ring, ring[:1]])
    drawn = ring + DRAWN * moved
    axes.plot(*closed.T, color=GREY, linewidth=0.8)
    axes.plot(*np.vstack([drawn, drawn[:1]]).T, ".-", color=color, linewidth=1.4, markersize=2.5)
    axes.set(xlim=(-1.3, 1.3), ylim=(-1.3, 1.3), aspect="equal")
    axes.set_title(title, fontsize=8.5)
    axes.axis("off")
