"""Draw a plan: the values that are drawn, and how deep the tips would be."""

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from rubgen.planning.plan import Plan
from rubgen.viz.colors import GREY
from rubgen.viz.figures.style import label_axes, new_figure, note

RUB, NO_RUB = "#c44e52", "#4c72b0"
COLUMNS, BINS, TICKS = 4, 12, 4
LOGARITHMIC = "{ log_uniform"


def plan_figure(made: Plan) -> Figure:
    """Draw a histogram of each key that varies in the examined runs, and of the free penetration in mm.

    Runs that can rub have another colour.
    """
    shown = [each for each in made.drawn if len(set(each.values)) > 1]
    rows = math.ceil((len(shown) + 1) / COLUMNS)
    figure = new_figure(3.2 * COLUMNS, 2.4 * rows + 0.6)
    axes = figure.subplots(rows, COLUMNS, squeeze=False).ravel()
    rubs = [each.can_rub for each in made.reach]
    depths = [1e3 * each.depth_m for each in made.reach]
    _histogram(axes[0], depths, rubs)
    label_axes(axes[0], "free penetration, mm", "runs")
    axes[0].axvline(0, color=GREY, linewidth=1)
    for panel, each in zip(axes[1:], shown, strict=False):
        logarithmic = each.how.startswith(LOGARITHMIC)
        _histogram(panel, each.values, [rubs[place] for place in each.runs], logarithmic=logarithmic)
        label_axes(panel, each.key, "runs")
    for panel in axes[len(shown) + 1 :]:
        panel.set_visible(False)
    share = f"{100 * made.share_that_can_rub:.0f} % of {len(rubs)} runs looked at can rub"
    figure.suptitle(f"Plan of {made.name}: {made.runs:,} runs of {made.machine}; {share}", fontsize=11)
    handles = axes[0].get_legend_handles_labels()
    figure.legend(*handles, loc="outside lower center", ncols=2, frameon=False, fontsize=9)
    return figure


def _histogram(axes: Axes, values: Sequence[float], rubs: Sequence[bool], *, logarithmic: bool = False) -> None:
    """Draw how many values are where, those of runs that can rub above the others."""
    found = [(value, rub) for value, rub in zip(values, rubs, strict=True) if math.isfinite(value)]
    if not found:
        note(axes, "not known before the run")
        return
    least, largest = min(found)[0], max(found)[0]
    bins = np.geomspace(least, largest, BINS + 1) if logarithmic else np.linspace(least, largest, BINS + 1)
    groups = [[value for value, rub in found if rub is wanted] for wanted in (False, True)]
    axes.hist(groups, bins=bins.tolist(), stacked=True, color=[NO_RUB, RUB], label=["cannot rub", "can rub"])
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, nbins=5))
    if logarithmic:
        axes.set_xscale("log")
        axes.set_xticks(_round_values(least, largest))
        axes.minorticks_off()
    else:
        axes.xaxis.set_major_locator(MaxNLocator(nbins=4))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _place: _text(value)))


def _round_values(least: float, largest: float) -> list[float]:
    """Return at most four round values from `least` to `largest`, and the two ends where there are none."""
    decades = range(math.floor(math.log10(least)), math.ceil(math.log10(largest)) + 1)
    for factors in ((1, 2, 5), (1, 3), (1,)):
        values = [factor * 10.0**decade for decade in decades for factor in factors]
        inside = [value for value in values if least <= value <= largest]
        if len(inside) <= TICKS:
            return inside or [least, largest]
    return inside[:: math.ceil(len(inside) / TICKS)]


def _text(value: float) -> str:
    return f"{value:,.0f}" if 1e3 <= abs(value) < 1e6 else f"{value:.3g}"
