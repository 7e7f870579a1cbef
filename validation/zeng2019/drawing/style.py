"""The look that the figures share, and small files for them."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.viz.colors import GREY

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK = "#222222"
DPI, COLORS = 110, 128
"""Few dots and few colours: no picture of the page reaches 300 kB."""


def new_figure(width: float, height: float) -> Figure:
    """An empty figure that no global state touches; sizes in inches."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def style(axes: Axes, x: str, y: str, title: str = "") -> None:
    """Labels and light frame."""
    axes.set_xlabel(x, fontsize=9, color=INK)
    axes.set_ylabel(y, fontsize=9, color=INK)
    axes.set_title(title, fontsize=9, color=INK)
    axes.tick_params(labelsize=8, colors=INK)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(GREY)


def png(figure: Figure) -> bytes:
    """The figure as a PNG of few colours, the same bytes for the same figure."""
    from PIL import Image

    raw = io.BytesIO()
    figure.savefig(raw, dpi=DPI, format="png", metadata={"Software": None})
    packed = io.BytesIO()
    # Rare colours stay, as those of single points are: the palette covers what there is, not what is frequent.
    few = Image.open(raw).convert("RGB").quantize(COLORS, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    few.save(packed, "PNG", optimize=True)
    return packed.getvalue()


def cascade(axes: Axes, values: FloatArray, spectra: FloatArray, unit: str) -> None:
    """Spectra (values, 1 + 100 orders) as a map over the value and the order, decades below the largest as shade."""
    decades = np.log10(np.maximum(spectra, 1e-30) / max(float(spectra.max()), 1e-30))
    count = min(spectra.shape[1], 1001)
    orders = np.arange(count) / 100
    # The largest line in each tenth of an order: thin lines must survive the page's resolution.
    bands = decades[:, : count - 1].reshape(len(values), -1, 10).max(axis=2)
    edges = np.append(orders[:-1:10] - 0.05, orders[-1] - 0.05)
    mesh = axes.pcolormesh(_edges(values), edges, bands.T, vmin=-4, vmax=0, cmap="Greys", rasterized=True)
    axes.set_ylim(0.2, 9.9)
    axes.set_yticks(range(1, 10))
    figure = axes.get_figure()
    if figure is not None:
        bar = figure.colorbar(mesh, ax=axes, pad=0.01, ticks=[-4, -2, 0])
        bar.set_label(f"decades below the largest, {unit}", fontsize=7)
        bar.ax.tick_params(labelsize=7)


def _edges(values: FloatArray) -> FloatArray:
    if len(values) == 1:
        return np.array([values[0] - 0.5, values[0] + 0.5])
    middle = (values[1:] + values[:-1]) / 2
    return np.concatenate([[2 * values[0] - middle[0]], middle, [2 * values[-1] - middle[-1]]])
