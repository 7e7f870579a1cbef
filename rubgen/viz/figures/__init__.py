"""Figures: functions that return a matplotlib Figure, in one house style, and touch no global state."""

from rubgen.viz.figures.bifurcation import bifurcation, exponent_sweep
from rubgen.viz.figures.campbell import campbell
from rubgen.viz.figures.cascade import spectrum_cascade
from rubgen.viz.figures.data_set import dataset_overview
from rubgen.viz.figures.mode_shapes import mode_shapes
from rubgen.viz.figures.replay import contact_distribution, orbit_section, waveform_orders
from rubgen.viz.figures.run import overview
from rubgen.viz.figures.style import save_figure, save_png

__all__ = [
    "bifurcation",
    "campbell",
    "contact_distribution",
    "dataset_overview",
    "exponent_sweep",
    "mode_shapes",
    "orbit_section",
    "overview",
    "save_figure",
    "save_png",
    "spectrum_cascade",
    "waveform_orders",
]
