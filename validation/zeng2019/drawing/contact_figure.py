"""Where the casing is touched and by which blades, in the paper's way: two rings for each run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rubgen.viz.colors import BLUE, VERMILION
from validation.zeng2019.drawing.style import new_figure
from validation.zeng2019.runs.outcome import Outcome

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def contact_figure(runs: dict[str, Outcome]) -> Figure:
    """For each run the impulse of the last 49 turns by angle on the casing (above) and by blade (below)."""
    figure = new_figure(9.5, 3.9)
    panels = figure.subplots(2, len(runs), subplot_kw={"projection": "polar"}, squeeze=False)
    for column, (name, run) in zip(panels.T, runs.items(), strict=True):
        for axes, impulse, color in zip(column, (run.on_casing, run.on_blades), (BLUE, VERMILION), strict=True):
            count = max(len(impulse), 1)
            top = max(float(impulse.max()), 1e-30) if len(impulse) else 1.0
            place = 2 * np.pi * (np.arange(len(impulse)) + (0.5 if color == BLUE else 0.0)) / count
            axes.bar(place, impulse / top, width=2 * np.pi / count, color=color, linewidth=0)
            axes.set(xticks=[], yticks=[], ylim=(-0.8, 1.05))
        column[0].set_title(f"{name}\n{run.label}", fontsize=8)
    return figure
