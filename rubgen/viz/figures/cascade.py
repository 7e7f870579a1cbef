"""Order spectra of many runs, or of one run along its time, as one map."""

import numpy as np
from matplotlib.figure import Figure

from rubgen.arrays import FloatArray
from rubgen.viz.figures.style import label_axes, new_figure

DECIBELS = 80.0


def spectrum_cascade(values: FloatArray, orders: FloatArray, amplitudes: FloatArray, *, y: str, unit: str) -> Figure:
    """Amplitudes (runs, orders) over order and `values` (runs,) as shade, in dB below the largest.

    Orders are in one row of equal steps; `y` labels the values, `unit` is that of the amplitudes.
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
