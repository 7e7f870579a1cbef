"""Draw what changes over a swept parameter: Poincare section, Lyapunov exponent, order spectra."""

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rubgen.arrays import FloatArray
from rubgen.labels.labels import Motion
from rubgen.viz.colors import GREY, MOTION_COLORS
from rubgen.viz.figures.style import MOTION_MARKERS, label_axes, motion_legend, new_figure

DECIBELS = 80.0
NOISE_RMS = 3.0
"""Of Gaussian noise 99.7 % lies within so many times its rms."""


def bifurcation(
    values: FloatArray, sections: Sequence[FloatArray], motions: Sequence[str], *, x: str, y: str, noise: float = 0.0
) -> Figure:
    """Draw a bifurcation diagram: the Poincare section of each run over the value of the swept parameter.

    A motion that repeats every turn is one point, a motion of period k is k points, chaos is a band.

    - values (runs,): the swept parameter.
    - sections: for each run, one coordinate of its motion once a turn (any,).
    - motions: class of motion of each run, which determines its colour.
    - x, y: labels of the axes, with units.
    - noise: rms of the sensor's noise in the unit of the sections. Above 0, a grey band of +-NOISE_RMS times the noise
      is drawn about zero: noise alone scatters the points of period-1 motion within it.
    """
    figure = new_figure(9.0, 4.8)
    axes = figure.subplots()
    if noise > 0:
        axes.axhspan(-NOISE_RMS * noise, NOISE_RMS * noise, color=GREY, alpha=0.3, linewidth=0, zorder=0)
    for value, section, motion in zip(values, sections, motions, strict=True):
        color = MOTION_COLORS[Motion(motion)]
        axes.plot(np.full(section.size, value), section, ".", color=color, markersize=3, markeredgewidth=0)
    label_axes(axes, x, y)
    axes.margins(x=0.01)
    dots: list[Artist] = [*motion_legend(motions, "o")]
    if noise > 0:
        dots.append(Patch(color=GREY, alpha=0.3, linewidth=0, label=f"noise of the sensor, ±{NOISE_RMS:g} rms"))
    figure.legend(handles=dots, loc="outside lower center", ncols=len(dots), frameon=False, fontsize=9)
    return figure


def exponent_sweep(
    values: FloatArray, exponents: FloatArray, errors: FloatArray, motions: Sequence[str], *, x: str
) -> Figure:
    """Draw the largest Lyapunov exponent of each run, in 1/turn, with its standard error, over the swept parameter.

    Above zero neighbouring trajectories separate: chaos. A forced system has no exponent that is always zero.

    - values (runs,): the swept parameter.
    - exponents, errors (runs,): exponent and its standard error, 1/turn.
    - motions: class of motion of each run.
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
    """Draw order spectra of several runs as a map: order to the right, parameter upward, amplitude as shade in dB.

    - values (runs,): the swept parameter.
    - orders (orders,): orders at equal steps.
    - amplitudes (runs, orders): amplitudes; 0 dB is the largest amplitude.
    - y: label of the parameter.
    - unit: unit of the amplitudes.
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
    """Return edges midway between ascending values."""
    if values.size == 1:
        return np.array([values[0] - 0.5, values[0] + 0.5])
    middle = (values[1:] + values[:-1]) / 2
    return np.concatenate([[2 * values[0] - middle[0]], middle, [2 * values[-1] - middle[-1]]])
