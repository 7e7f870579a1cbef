"""The reliability diagram: how often runs of a confidence keep their class with half the step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from rubgen.viz.colors import BLUE, GREY, ORANGE
from validation.sensitivity.confidence import KEPT_WHERE_SURE, SURE, bins
from validation.sensitivity.recipes import Halved

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLORS = (BLUE, ORANGE)


def reliability_figure(pairs: Mapping[str, Sequence[Halved]]) -> Figure:
    """Share of kept classes over the mean confidence of each bin, by the use of the runs; below, numbers of runs."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 7.0), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    shares, counts = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
    shares.plot([0, 1], [0, 1], color=GREY, linewidth=1, linestyle="--")
    shares.plot([SURE, 1], [KEPT_WHERE_SURE, KEPT_WHERE_SURE], color=GREY, linewidth=2, label="required")
    for shift, (use, color) in zip((-0.006, 0.006), zip(pairs, COLORS, strict=False), strict=False):
        found = bins(pairs[use])
        x, y = [each.mean_confidence + shift for each in found], [each.kept / each.runs for each in found]
        below = [share - each.interval[0] for share, each in zip(y, found, strict=True)]
        above = [each.interval[1] - share for share, each in zip(y, found, strict=True)]
        errors = [[max(size, 0.0) for size in side] for side in (below, above)]
        shares.errorbar(x, y, yerr=errors, fmt="o-", color=color, markersize=6, capsize=3, label=use)
        counts.bar(x, [each.runs for each in found], width=0.01, color=color)
    shares.set_ylabel("share that keeps class and period at 2,048 steps")
    shares.legend(frameon=False, loc="upper left")
    counts.set_ylabel("runs")
    counts.set_xlabel("motion_confidence at 1,024 steps")
    for axes in (shares, counts):
        axes.spines[["top", "right"]].set_visible(False)
    return figure
