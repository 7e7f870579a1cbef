"""The paper's way to show a sweep: 49 points and spectra over the value, of the blisk and of the casing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rubgen.labels import Motion
from rubgen.viz.colors import MOTION_COLORS
from validation.zeng2019.drawing.style import cascade, new_figure, style
from validation.zeng2019.runs.measures import motion_of
from validation.zeng2019.runs.outcome import Outcome

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PARTS = {"blisk": ("Disk centre $x$, µm", 1e6, "m"), "casing": ("Casing acceleration, m/s²", 1.0, "m/s²")}
COLOR_NAMES = "blue period-1, green period-k, orange quasi-periodic, sky undecided, red chaotic, grey static"


def sweep_figure(
    runs: dict[float, Outcome], name: str, *, bands: dict[str, tuple[float, float]] | None = None, log: bool = False
) -> Figure:
    """Left the points, coloured by class, right the orders; above the blisk, below the casing.

    `bands` are the paper's ranges, marked at the top. Failed runs are left out.
    """
    good = {value: run for value, run in runs.items() if run.ok}
    figure = new_figure(9.5, 5.4)
    panels = figure.subplots(2, 2, sharex=True)
    for row, (part, (label, scale, unit)) in zip(panels, PARTS.items(), strict=True):
        _points(row[0], good, part, scale)
        style(row[0], name if part == "casing" else "", label)
        spectra = np.array([getattr(run, f"spectrum_{part}") for run in good.values()])
        if good and log:
            _log_note(row[1])
        if good:
            cascade(row[1], np.array(list(good)), spectra, unit)
        style(row[1], name if part == "casing" else "", f"Order, {part}")
        for band, (low, high) in (bands or {}).items():
            row[0].axvline(low, color="#dddddd", linewidth=0.6, zorder=0)
            row[0].text((low * high) ** 0.5 if log else (low + high) / 2, 1.0, band, fontsize=7, ha="center",
                        va="bottom", transform=row[0].get_xaxis_transform())  # fmt: skip
    if log:
        panels[0, 0].set_xscale("log")
    return figure


def _points(axes: Axes, runs: dict[float, Outcome], part: str, scale: float) -> None:
    for motion, color in MOTION_COLORS.items():
        chosen = {value: run for value, run in runs.items() if motion_of(run, part) == Motion(motion).value}
        if chosen:
            values = np.repeat(list(chosen), [len(getattr(run, f"points_{part}")) for run in chosen.values()])
            points = np.concatenate([getattr(run, f"points_{part}") for run in chosen.values()])
            axes.plot(values, scale * points, ".", color=color, markersize=2.5, markeredgewidth=0)


def _log_note(axes: Axes) -> None:
    axes.set_xscale("log")
