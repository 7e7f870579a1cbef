"""The figure of this study: where the indicators put each run, and where they disagree over the speed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rubgen.labels.motion.clusters import CLUSTER_RADIUS
from rubgen.viz.colors import BLUE, GREEN, GREY, ORANGE, VERMILION
from validation.confusion.runs import SERIES, run_name
from validation.confusion.verdicts import AGREE, Case, ZeroOne

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SMALLEST = 1e-8
COLORS = {"periodic": BLUE, "quasi-periodic": GREEN, "chaotic": VERMILION, "disagree": ORANGE}


def confusion_figure(cases: Sequence[Case]) -> Figure:
    """Exponent over stray, coloured by the 0-1 test; below, agreement of each series over the speed."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 7.5), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    plane, speeds = figure.subplots(2, 1, height_ratios=(3, 1))
    _draw_plane(plane, cases)
    _draw_speeds(speeds, cases)
    return figure


def _draw_plane(axes: Axes, cases: Sequence[Case]) -> None:
    for test, color, marker in ((ZeroOne.REGULAR, BLUE, "o"), (ZeroOne.CHAOS, VERMILION, "s")):
        shown = [case for case in cases if case.verdict[1] is test]
        stray = [max(case.stray, SMALLEST) for case in shown]
        exponent = [case.exponent.per_turn for case in shown]
        label = f"0-1 test: {test.value}"
        axes.errorbar(
            stray, exponent, yerr=[2 * case.exponent.error for case in shown], fmt=marker, color=color,
            markersize=4, elinewidth=0.8, label=label,
        )  # fmt: skip
    axes.axvline(CLUSTER_RADIUS, color=GREY, linewidth=1, linestyle="--")
    axes.axhline(0, color=GREY, linewidth=1)
    axes.set_xscale("log")
    axes.set_yscale("symlog", linthresh=0.01)
    axes.set_xlabel("what does not repeat, over the motion (dashed: clusters find a period to its left)")
    axes.set_ylabel("Lyapunov exponent, 1/turn, two errors")
    axes.legend(frameon=False, loc="lower right")
    axes.spines[["top", "right"]].set_visible(False)


def _draw_speeds(axes: Axes, cases: Sequence[Case]) -> None:
    names = list(SERIES)
    for kind, color in COLORS.items():
        places = [_place(case, names) for case in cases if AGREE.get(case.verdict, "disagree") == kind]
        x, y = ([place[i] for place in places] for i in range(2))
        axes.plot(x, y, "s", color=color, markersize=5, label=kind)
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.4, -1.4)
    axes.set_xlabel("speed, rev/min")
    axes.legend(frameon=False, ncols=len(COLORS), loc="upper right", fontsize=9)
    axes.spines[["top", "right"]].set_visible(False)


def _place(case: Case, names: Sequence[str]) -> tuple[float, int]:
    """Speed and row of a run, from its name."""
    series, _, rest = case.name.partition(", ")
    speed = float(rest.split()[0])
    if run_name(series, speed) != case.name:
        raise ValueError(f"{case.name}: no run of this study")
    return speed, names.index(series)
