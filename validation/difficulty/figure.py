"""The figure of this study: the score over the level of the background."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.baseline.scores import best_threshold
from rubgen.viz.colors import BLUE, GREY, VERMILION
from validation.difficulty.runs import Cases
from validation.difficulty.scores import Boosted, Flags

if TYPE_CHECKING:
    from matplotlib.figure import Figure

GROUPS = 5


def background_groups(background: FloatArray) -> list[Flags]:
    """Groups (runs,) of equal size from the quietest to the loudest; one where the level does not vary."""
    if np.ptp(background) == 0:
        return [np.ones(background.size, dtype=bool)]
    ranks = np.argsort(np.argsort(background, kind="stable"), kind="stable")
    return [ranks * GROUPS // background.size == group for group in range(GROUPS)]


def background_figure(found: Cases, learned: Boosted, threshold: FloatArray) -> Figure:
    """Balanced accuracy in five groups of the background.

    - found: the runs.
    - learned: gradient boosting on the accelerometers.
    - threshold (runs,): the feature with the best threshold of all.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 4.0), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    groups = background_groups(found.background)
    level = [float(np.median(found.background[group])) for group in groups]
    scores = np.array([learned.accuracy(group) for group in groups])
    single = [best_threshold(threshold[group], found.rub[group]).score for group in groups]
    axes.errorbar(level, scores[:, 0], yerr=scores[:, 1], fmt="o-", color=BLUE, label="gradient boosting")
    axes.plot(level, single, "s--", color=VERMILION, label="best single threshold, chosen in the group")
    axes.axhline(0.5, color=GREY, linewidth=1)
    axes.set_xscale("log" if min(level) > 0 else "linear")
    axes.set_ylim(0.4, 1.02)
    axes.set_xlabel("background, m/s2 rms, median of a fifth of the runs")
    axes.set_ylabel("balanced accuracy of rub")
    axes.set_title("How well a rub is found over the level of the background")
    axes.legend(frameon=False, loc="lower left")
    axes.spines[["top", "right"]].set_visible(False)
    return figure
