"""The figures of the sensitivity studies."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from rubgen.labels import Motion
from rubgen.viz.colors import BLUE, GREEN, GREY, MOTION_COLORS, ORANGE, VERMILION
from validation.sensitivity.cases import CASES, Study
from validation.sensitivity.halving import IMPULSE_TOLERANCE, Pair
from validation.sensitivity.outcome import Outcome
from validation.sensitivity.results import Results, change, of_case

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

PURPLE = "#cc79a7"
CASE_COLORS = dict(zip(CASES, (BLUE, GREEN, ORANGE, VERMILION, PURPLE), strict=True))
QUANTITIES: dict[str, Callable[[Outcome], float]] = {
    "Impulse a turn": lambda outcome: outcome.impulse,
    "Contact force, order 2": lambda outcome: outcome.force_orders[1],
    "Contact force, order 4": lambda outcome: outcome.force_orders[3],
    "Disk centre x, order 3": lambda outcome: outcome.blisk_orders[2],
    "Disk centre x, order 1": lambda outcome: outcome.blisk_orders[0],
}


def study_figure(study: Study, results: Results) -> Figure:
    """Four panels over the values: impulse and orders, in percent of those at the yardstick; the mark is the class.

    Order 1 of the disk centre, the unbalance's own, is left to the table: it hardly changes.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 6.4), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    panels = figure.subplots(2, 2, sharex=True).ravel()
    for axes, (name, read) in zip(panels, QUANTITIES.items(), strict=False):
        _changes(axes, study, results, read)
        _style(axes, "", f"{name}, change in %")
    for axes in panels[2:]:
        axes.set_xlabel(study.quantity, fontsize=10, color=_ink())
    handles = _case_legend() + _motion_legend([result.outcome for result in results])
    figure.legend(handles=handles, loc="outside lower center", ncols=5, frameon=False, fontsize=9)
    return figure


def _changes(axes: Axes, study: Study, results: Results, read: Callable[[Outcome], float]) -> None:
    from rubgen.viz.colors import PAPER_GREY
    from rubgen.viz.figures.style import MOTION_MARKERS

    values = sorted({result.value for result in results}, key=_place)
    yardstick = study.yardstick if study.yardstick in values else values[-1]
    if study.default in values:
        axes.axvline(values.index(study.default), color=PAPER_GREY, linewidth=8, zorder=0)
    axes.axhline(0, color=GREY, linewidth=0.7, zorder=1)
    for number, (name, color) in enumerate(CASE_COLORS.items()):
        outcomes = of_case(results, name)
        x = [values.index(value) + 0.09 * (number - 2) for value in outcomes]
        y = [100 * change(outcome, outcomes[yardstick], read) for outcome in outcomes.values()]
        axes.plot(x, y, color=color, linewidth=0.8, alpha=0.6)
        for place, height, outcome in zip(x, y, outcomes.values(), strict=True):
            if outcome.motion:
                axes.plot(place, height, MOTION_MARKERS[Motion(outcome.motion)], color=color, markersize=5.5)
            else:
                axes.plot(place, 0.04, "x", color=color, markersize=6.5, transform=axes.get_xaxis_transform())
    axes.set_yscale("symlog", linthresh=1, linscale=1.5)
    _percent_ticks(axes)
    axes.set_xticks(range(len(values)), [study.text(value) for value in values])


def _percent_ticks(axes: Axes, least: float = 1.0) -> None:
    """Ticks at 0, +-1, +-10, ... as far as the marks reach, +-`least` at least."""
    heights = [abs(float(y)) for line in axes.lines for y in np.asarray(line.get_ydata(), dtype=np.float64)]
    reach = max([height for height in heights if math.isfinite(height)] + [least])
    decades = range(math.ceil(math.log10(reach)) + 1)
    ticks = sorted({0.0} | {sign * 10.0**decade for decade in decades for sign in (-1, 1)})
    axes.set_ylim(-1.6 * reach, 1.6 * reach)
    axes.set_yticks([tick for tick in ticks if abs(tick) <= 1.6 * reach])
    axes.set_yticklabels([f"{tick:+.0f}".replace("+0", "0").replace("-", "−") for tick in axes.get_yticks()])
    axes.minorticks_off()


def halving_figure(pairs: Sequence[Pair]) -> Figure:
    """Impulse over speed with either step, coloured by class, and its change on period-1 runs."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 6.4), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[1.6, 1])
    _impulses(upper, pairs)
    _impulse_changes(lower, pairs)
    handles = _motion_legend([run for pair in pairs for run in (pair.whole, pair.half)], colored=True)
    figure.legend(handles=handles + _step_legend(), loc="outside lower center", ncols=4, frameon=False, fontsize=9)
    return figure


def _impulses(axes: Axes, pairs: Sequence[Pair]) -> None:
    from rubgen.viz.colors import PAPER_GREY
    from rubgen.viz.figures.style import MOTION_MARKERS

    for pair in pairs:
        if not pair.equal:
            axes.axvline(pair.speed_rpm, color=PAPER_GREY, linewidth=4, zorder=0)
        for run, size, fill in ((pair.whole, 7.0, "none"), (pair.half, 3.5, None)):
            motion = Motion(run.motion) if run.motion else None
            color = MOTION_COLORS[motion] if motion else GREY
            marker = MOTION_MARKERS[motion] if motion else "x"
            axes.plot(pair.speed_rpm, run.impulse, marker, markersize=size, color=color, markerfacecolor=fill or color)
    axes.set_yscale("symlog", linthresh=0.1, linscale=0.6)
    axes.set_yticks([0, 0.1, 1, 10], ["0", "0.1", "1", "10"])
    axes.set_ylim(bottom=-0.02)
    _style(axes, "", "Contact impulse a turn, N s")


def _impulse_changes(axes: Axes, pairs: Sequence[Pair]) -> None:
    from rubgen.viz.colors import PAPER_GREY
    from rubgen.viz.figures.style import MOTION_MARKERS

    shown = [(pair.speed_rpm, pair.impulse_change) for pair in pairs if pair.impulse_change is not None]
    bound = 100 * IMPULSE_TOLERANCE
    axes.axhspan(-bound, bound, color=PAPER_GREY, alpha=0.5, linewidth=0)
    marker, color = MOTION_MARKERS[Motion.PERIOD_1], MOTION_COLORS[Motion.PERIOD_1]
    axes.plot([speed for speed, _ in shown], [100 * value for _, value in shown], marker, color=color, markersize=5)
    axes.set_yscale("symlog", linthresh=bound)
    _percent_ticks(axes, 2 * bound)
    _style(axes, "Speed, rev/min", "Impulse of period-1 runs,\nchange in %")


def _case_legend() -> list[Line2D]:
    from matplotlib.lines import Line2D

    return [Line2D([], [], color=color, linewidth=2, label=name) for name, color in CASE_COLORS.items()]


def _motion_legend(outcomes: Sequence[Outcome], *, colored: bool = False) -> list[Line2D]:
    from matplotlib.lines import Line2D

    from rubgen.viz.figures.style import MOTION_MARKERS

    found = {outcome.motion for outcome in outcomes}
    marks = [
        (motion.value, MOTION_MARKERS[motion], MOTION_COLORS[motion] if colored else GREY)
        for motion in Motion
        if motion.value in found
    ]
    failed = [("failed run, at the foot", "x", GREY)] if "" in found else []
    return [
        Line2D([], [], linestyle="none", marker=marker, color=color, label=name)
        for name, marker, color in marks + failed
    ]


def _step_legend() -> list[Line2D]:
    from matplotlib.lines import Line2D

    from rubgen.viz.colors import PAPER_GREY

    return [
        Line2D([], [], linestyle="none", marker="o", color=_ink(), markerfacecolor="none", label="1,024 steps a turn"),
        Line2D([], [], linestyle="none", marker="o", color=_ink(), markersize=3.5, label="2,048 steps a turn"),
        Line2D([], [], color=PAPER_GREY, linewidth=4, label="labels differ"),
    ]


def _style(axes: Axes, x: str, y: str) -> None:
    axes.set_xlabel(x, fontsize=10, color=_ink())
    axes.set_ylabel(y, fontsize=10, color=_ink())
    axes.tick_params(labelsize=9, colors=_ink())
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(GREY)


def _ink() -> str:
    from rubgen.viz.figures.style import INK

    return INK


def _place(value: int) -> float:
    """Where a value stands: "auto", 0, comes last."""
    return value or math.inf
