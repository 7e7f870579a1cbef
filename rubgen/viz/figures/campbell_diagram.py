"""Draw the natural frequencies of a machine over the speed, with the exciting orders."""

from collections.abc import Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rubgen.arrays import FloatArray
from rubgen.reduction import ReducedModel
from rubgen.reduction.modes import Mode, blisk_modes, critical_speeds_rpm
from rubgen.units import rad_per_s
from rubgen.viz.colors import BLUE, GREY, ORANGE, VERMILION
from rubgen.viz.figures.style import INK, label_axes, new_figure, speeds_in_words

HIGHEST_RPM, SPEEDS = 15_000.0, 41
CASING_MODES = 11
HIGHEST_ORDER = 8
SLOWEST_RPM = 60.0
"""Stands for rest, where both waves of a pair have one frequency and cannot be told apart."""
Band = tuple[float, float]
"""Lowest and highest frequency of a panel, Hz."""
ABOVE_CRITICAL = 1.2
"""The diagram reaches at least this many times the critical speed."""


def campbell(
    model: ReducedModel,
    speeds_rpm: tuple[float, float] | None = None,
    frequencies_hz: Band | None = None,
) -> Figure:
    """Draw Campbell diagrams: the whirl of the disk and the waves of the blades, and the casing.

    Left, in the inertial frame: modes of one nodal diameter, the only modes that move the disk centre sideways. A
    critical speed is where a forward mode meets 1X. Uneven springs count with their mean in the modes, and each has a
    dotted critical speed. Middle, in the turning frame: modes of all nodal diameters n.
    Stationary forces excite n waves at order n; each crossing of the backward wave is marked. Right: modes of the
    casing in the inertial frame, and where the blisk, which turns under N lobes, excites them at orders k N. All modes
    are without contact; modes of the blisk are damped.

    - speeds_rpm: range of speed in rev/min. None is from 0 to 1.2 times the critical speed, at least to 15,000.
    - frequencies_hz: range of frequency in Hz. None chooses it for each panel.
    """
    low, high = speeds_rpm or (0.0, max(HIGHEST_RPM, ABOVE_CRITICAL * model.critical_speed_rpm))
    speeds = np.linspace(low, high, SPEEDS)
    modes = [blisk_modes(model, rad_per_s(max(speed, SLOWEST_RPM))) for speed in speeds]
    figure = new_figure(14.0, 5.4)
    whirl, waves, casing = figure.subplots(1, 3)
    _whirl(whirl, model, speeds, modes, frequencies_hz)
    _waves(waves, model, speeds, modes, frequencies_hz)
    _casing(casing, model, speeds, frequencies_hz)
    figure.suptitle(f"{model.machine.name}: Campbell diagram without contact", fontsize=11, color=INK)
    return figure


def branches(modes: Sequence[Sequence[Mode]], waves: int) -> FloatArray:
    """Return the modes of `waves` nodal diameters at each speed (speeds, branches, 3).

    Values are the frequencies in the turning and in the inertial frame, Hz, with signs, and the damping ratio. Modes of
    one nodal diameter veer and do not cross in the turning frame, so their order there makes the branches. Where a mode
    stops to oscillate at some speeds, the highest branch is left out.
    """
    rows = []
    for each in modes:
        found = sorted((x for x in each if x.nodal_diameters == waves), key=lambda x: x.turning_hz)
        rows.append([(x.turning_hz, x.inertial_hz, x.damping_ratio) for x in found])
    count = min(map(len, rows))
    return np.array([row[:count] for row in rows]).reshape(len(rows), count, 3)


def crossings(speeds: FloatArray, hertz: FloatArray, order: float) -> FloatArray:
    """Return the speeds (any,) in rev/min at which a frequency meets the order `order` of the rotation.

    `hertz` (speeds,) are the frequencies in Hz at `speeds` (speeds,) in rev/min, ascending; between two speeds they are
    linear. A meeting is counted where the frequency crosses the order, upward or downward, between two neighbouring
    speeds. It is not counted where both are equal exactly at one of `speeds`, or where a frequency is NaN.
    """
    above = hertz - order * speeds / 60
    at = np.flatnonzero(above[:-1] * above[1:] < 0)
    share = above[at] / (above[at] - above[at + 1])
    met: FloatArray = speeds[at] + share * (speeds[at + 1] - speeds[at])
    return met


def _whirl(
    axes: Axes, model: ReducedModel, speeds: FloatArray, modes: Sequence[Sequence[Mode]], band: Band | None
) -> None:
    lines = branches(modes, 1)
    criticals = critical_speeds_rpm(model)
    band = band or (0.0, 2.2 * max(model.critical_speed_rpm, HIGHEST_RPM / 2) / 60)
    _orders(axes, speeds, band, range(1, HIGHEST_ORDER + 1))
    for _turning, seen, ratio in lines.transpose(1, 2, 0):
        forward = seen > 0
        for part, color, style in ((forward, BLUE, "-"), (~forward, ORANGE, "--")):
            axes.plot(speeds, np.where(part, np.abs(seen), np.nan), style, color=color, linewidth=1.2, zorder=3)
        for met in crossings(speeds, np.where(forward, seen, np.nan), 1.0):
            damping = 100 * float(np.interp(met, speeds, ratio))
            _mark(axes, met, met / 60, f"{met:,.0f} rev/min, {damping:.1f} %")
    for critical in criticals:
        axes.axvline(critical, color=VERMILION, linewidth=0.8, linestyle=":", zorder=1)
    handles = [Line2D([], [], color=BLUE, label="forward"), Line2D([], [], color=ORANGE, ls="--", label="backward")]
    _legend(axes, handles)
    frame = "Whirl, inertial frame" if len(criticals) == 1 else "Whirl, mean springs"
    axes.set_title(f"{frame}; undamped critical {speeds_in_words(criticals)} rev/min", fontsize=9.5, pad=14)
    _finish(axes, speeds, band, "Frequency of one nodal diameter, Hz")


def _waves(
    axes: Axes, model: ReducedModel, speeds: FloatArray, modes: Sequence[Sequence[Mode]], band: Band | None
) -> None:
    every = range(model.machine.blades.count // 2 + 1)
    lines = {waves: branches(modes, waves) for waves in every}
    band = band or (0.0, 1.6 * float(np.abs(lines[min(2, max(every))][-1, :, 0]).min()))
    _orders(axes, speeds, band, range(1, HIGHEST_ORDER + 1))
    colors = colormaps["viridis"](np.linspace(0, 0.9, len(lines)))
    for (waves, found), color in zip(lines.items(), colors, strict=True):
        axes.plot(speeds, np.abs(found[..., 0]), color=color, linewidth=0.9, zorder=3)
        for seen in found[..., 1].T if waves else ():
            for met in crossings(speeds, seen, 0.0):  # there the wave stands still in the inertial frame
                axes.plot(met, waves * met / 60, "o", color=VERMILION, markersize=3.5, zorder=4)
    ends = [(0, colors[0]), (max(every), colors[-1])]
    handles = [Line2D([], [], color=color, label=f"ND {waves}") for waves, color in ends]
    crossing = Line2D([], [], ls="none", marker="o", color=VERMILION, ms=4, label="backward, order = ND")
    _legend(axes, [*handles, crossing])
    axes.set_title("Blades, turning frame, all nodal diameters", fontsize=9.5, pad=14)
    _finish(axes, speeds, band, "Frequency, Hz")


def _mark(axes: Axes, speed: float, hertz: float, text: str) -> None:
    axes.plot(speed, hertz, "o", color=VERMILION, markersize=4, zorder=5)
    axes.annotate(
        text, (speed, hertz), xytext=(6, -4), textcoords="offset points", fontsize=8, color=VERMILION, va="top",
        ha="left" if speed < 0.6 * axes.get_xlim()[1] else "center", zorder=6, annotation_clip=True,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1, "alpha": 0.8},
    )  # fmt: skip


def _casing(axes: Axes, model: ReducedModel, speeds: FloatArray, band: Band | None) -> None:
    """Draw constant frequencies, with points where an order of the lobes crosses one of the casing's modes."""
    hertz = model.casing_frequencies_hz[:CASING_MODES]
    lobes = model.machine.casing.lobes
    band = band or (0.0, 1.08 * float(hertz.max()))
    orders = [lobes * k for k in range(1, max(HIGHEST_ORDER // lobes, 1) + 1)]
    _orders(axes, speeds, band, orders)
    axes.hlines(hertz, speeds[0], speeds[-1], color=BLUE, linewidth=1.1, zorder=3)
    met = np.array([(60 * f / order, f) for order in orders for f in hertz])
    met = met[(met[:, 0] >= speeds[0]) & (met[:, 0] <= speeds[-1])]
    axes.plot(*met.T, "o", color=VERMILION, markersize=3.5, zorder=4)
    axes.set_title(f"Casing, inertial frame, orders of {lobes} lobes", fontsize=9.5, pad=14)
    _finish(axes, speeds, band, "Frequency, Hz")


def _orders(axes: Axes, speeds: FloatArray, band: Band, orders: range | list[int]) -> None:
    """Draw lines k f_r, numbered where they leave the panel."""
    for order in orders:
        begin, end = max(speeds[0], 60 * band[0] / order), min(speeds[-1], 60 * band[1] / order)
        if begin >= end:
            continue
        axes.plot([begin, end], [order * begin / 60, order * end / 60], color=GREY, linewidth=0.6, zorder=1)
        inside = end < speeds[-1]
        axes.annotate(
            f"{order}", (end, order * end / 60), xytext=(0, 2) if inside else (3, 0), textcoords="offset points",
            ha="center" if inside else "left", va="bottom" if inside else "center", fontsize=8, color=INK,
        )  # fmt: skip


def _legend(axes: Axes, handles: list[Line2D]) -> None:
    """Put a legend below the panel, where it covers nothing."""
    axes.legend(
        handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=len(handles), fontsize=8, frameon=False
    )


def _finish(axes: Axes, speeds: FloatArray, band: Band, text: str) -> None:
    axes.set(xlim=(speeds[0], speeds[-1]), ylim=band)
    label_axes(axes, "Speed, rev/min (grey: orders of rotation)", text)
