"""The figures of this study."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rubgen.viz.colors import BLUE, LINES, VERMILION
from validation.contact_options.chords import Artefact
from validation.contact_options.matched import Compared
from validation.contact_options.runs import Found

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SHOWN_NODES = 5


def chords_figure(artefact: Artefact, smooth: Compared, chords: Compared) -> Figure:
    """How chords lie and approach over a few nodes, and what becomes of a run on them."""
    figure, panels = _figure(4)
    shown = artefact.angle < 2 * np.pi * SHOWN_NODES / len(artefact.hits)
    degrees = np.rad2deg(artefact.angle[shown])
    panels[0].plot(degrees, 1e6 * artefact.inside[shown], color=VERMILION)
    _label(panels[0], "polar angle, degrees", "chords inside the smooth curve, um")
    panels[1].plot(degrees, artefact.approach[shown], color=VERMILION)
    _label(panels[1], "polar angle, degrees", "approach to a passing tip, m/s")
    for found, color, name in ((chords, VERMILION, "chords"), (smooth, BLUE, "smooth")):
        panels[2].plot(found.impulse, color=color, linewidth=0.8, label=name)
        x, y = 1e6 * found.centre.T
        panels[3].plot(x, y, ".", color=color, markersize=3)
    _label(panels[2], "turn of the record", "impulse a turn, N s")
    panels[2].set_ylim(bottom=0)
    panels[2].legend(frameon=False, fontsize=9)
    _label(panels[3], "disk centre x once a turn, um", "disk centre y, um")
    return figure


def liner_figure(found: Sequence[Found]) -> Figure:
    """Worn profiles, and the impulses a turn while they are worn."""
    figure, panels = _figure(2)
    colors = dict(zip(dict.fromkeys(each.case for each in found), LINES, strict=False))
    for each in found:
        worn, color = each.worn, colors[each.case]
        if worn is None:
            continue
        style = "--" if each.option != "liner" else "-"
        label = each.case if style == "-" else f"{each.case}, softer"
        panels[0].plot(np.rad2deg(worn.angle), 1e3 * worn.depth, style, color=color, linewidth=1, label=label)
        panels[1].plot(each.impulse, style, color=color, linewidth=0.8)
    _label(panels[0], "polar angle, degrees", "worn depth, mm")
    figure.legend(loc="outside lower center", ncols=5, frameon=False, fontsize=8)
    _label(panels[1], "turn of the record", "impulse a turn, N s")
    panels[0].set_title("profile of the liner after the record", fontsize=9)
    panels[1].set_title("normal impulse while it wears", fontsize=9)
    return figure


def _figure(panels: int) -> tuple[Figure, list[Axes]]:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    rows = panels // 2
    figure = Figure(figsize=(10.0, 3.2 * rows), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    return figure, list(np.ravel(figure.subplots(rows, 2)))


def _label(axes: Axes, x: str, y: str) -> None:
    axes.set_xlabel(x, fontsize=9)
    axes.set_ylabel(y, fontsize=9)
    axes.tick_params(labelsize=8)
    axes.spines[["top", "right"]].set_visible(False)
