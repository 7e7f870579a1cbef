"""Figures: functions that return a matplotlib Figure, in one style, without global state."""

from rubgen.viz.figures.campbell_diagram import campbell
from rubgen.viz.figures.data_set import dataset_overview
from rubgen.viz.figures.modes_at_rest import mode_shapes
from rubgen.viz.figures.response import critical_map, unbalance_response
from rubgen.viz.figures.run import contact_distribution, orbit_section, overview, waveform_orders
from rubgen.viz.figures.run_up import bode, waterfall
from rubgen.viz.figures.style import save_figure, save_png
from rubgen.viz.figures.sweeps import bifurcation, exponent_sweep, spectrum_cascade

__all__ = [
    "bifurcation",
    "bode",
    "campbell",
    "contact_distribution",
    "critical_map",
    "dataset_overview",
    "exponent_sweep",
    "mode_shapes",
    "orbit_section",
    "overview",
    "save_figure",
    "save_png",
    "spectrum_cascade",
    "unbalance_response",
    "waterfall",
    "waveform_orders",
]
