"""Sweeps: the motion once a turn, the Lyapunov exponent, and order spectra as a map."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from rubgen.arrays import FloatArray
from rubgen.labels.labels import Motion
from rubgen.viz.colors import GREY, MOTION_COLORS
from rubgen.viz.figures.style import MOTION_MARKERS, label_axes, motion_legend, new_figure

DECIBELS = 80.0


def bifurcation(
    values: FloatArray, sections: Sequence[FloatArray], motions: Sequence[str], *, x: str, y: str
) -> Figure:
    """The Poincare section of each run over its parameter: one point for a motion that repeats every turn.

    A motion of period k has k points.

    - values (runs,): of the parameter.
    - sections: an array (any,) for each run.
    - motions: class of each run.
    - x, y: labels of the axes, with units.
    """
    figure = new_figure(9.0, 4.8)
    axes = figure.subplots()
    for value, section, motion in zip(values, sections, motions, strict=True):
        color = MOTION_COLORS[Motion(motion)]
        axes.plot(np.full(section.size, value), section, ".", color=color, markersize=3, markeredgewidth=0)
    label_axes(axes, x, y)
    axes.margins(x=0.01)
    dots = motion_legend(motions, "o")
    figure.legend(handles=dots, loc="outside lower center", ncols=len(dots), frameon=False, fontsize=9)
    return figure


def exponent_sweep(
    values: FloatArray, exponents: FloatArray, errors: FloatArray, motions: Sequence[str], *, x: str
) -> Figure:
    """The largest Lyapunov exponent of each run over its parameter, 1/turn, with its standard error.

    Above zero neighbouring trajectories separate: chaos. A forced system has no exponent that must be zero.

    - values, exponents, errors (runs,): of the runs.
    - motions: class of each run.
    - x: label of the parameter, with its unit.
    """
    figure = new_figure(9.0, 4.2)
    axes = figure.subplots()
    axes.axhline(0, color=GREY, linewidth=0.8)
    for value, exponent, error, motion in zip(values, exponents, errors, motions, strict=True):
        kind = Motion(motion)
        axes.errorbar(
            value, exponent, yerr=error, fmt=MOTION_MARKERS[kind], color=MOTION_COLORS[kind], markersize=4.5,
            elinewidth=0.8, capsize=1.5,
        )  # fmt: skip
    label_axes(axes, x, "Largest Lyapunov exponent, 1/turn")
    axes.margins(x=0.01)
    figure.legend(handles=motion_legend(motions), loc="outside lower center", ncols=5, frameon=False, fontsize=9)
    return figure


def spectrum_cascade(values: FloatArray, orders: FloatArray, amplitudes: FloatArray, *, y: str, unit: str) -> Figure:
    """Amplitudes (runs, orders) over order and `values` (runs,) as shade, in dB below the largest.

    Orders have equal steps. `y` is the label of the values, `unit` the unit of the amplitudes.
    """
    figure = new_figure(9.0, 5.0)
    axes = figure.subplots()
    order = np.argsort(values)
    largest = float(amplitudes.max()) or 1.0
    decibel = 20 * np.log10(np.maximum(amplitudes[order] / largest, 10 ** (-DECIBELS / 20)))
    half = (orders[1] - orders[0]) / 2 if orders.size > 1 else 0.5
    mesh = axes.pcolormesh(
        np.append(orders - half, orders[-1] + half), _edges(values[order]), decibel, cmap="viridis", vmin=-DECIBELS,
        vmax=0, rasterized=True,
    )  # fmt: skip
    bar = figure.colorbar(mesh, ax=axes, pad=0.01)
    bar.set_label(f"dB re {largest:.3g} {unit}", fontsize=10)
    bar.ax.tick_params(labelsize=9)
    label_axes(axes, "Order $f / f_r$", y)
    axes.set_xticks(range(int(orders[-1]) + 1))
    return figure


def _edges(values: FloatArray) -> FloatArray:
    """Edges midway between ascending values."""
    if values.size == 1:
        return np.array([values[0] - 0.5, values[0] + 0.5])
    middle = (values[1:] + values[:-1]) / 2
    return np.concatenate([[2 * values[0] - middle[0]], middle, [2 * values[-1] - middle[-1]]])
