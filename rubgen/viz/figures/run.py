"""One run in four panels, from its true response."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.projections.polar import PolarAxes

from rubgen.arrays import FloatArray
from rubgen.labels.harmonics import order_spectrum, spectrum_turns
from rubgen.viz.colors import BLUE, GREY, PAPER_GREY, VERMILION
from rubgen.viz.figures.contact_map import contact_map
from rubgen.viz.figures.style import label_axes, new_figure, note

if TYPE_CHECKING:
    from rubgen.pipeline import Run

ORBIT_TURNS = 30
WAVE_TURNS = 5
HIGHEST_ORDER = 12


def overview(run: Run) -> Figure:
    """Four panels: orbit with its section, casing acceleration, spectrum and polar map of the contact force.

    Orbit, spectrum and map show the true response, the waveform the recorded channel. Raises ValueError for a run
    without a recording.
    """
    if run.recording is None:
        raise ValueError(f"{run.scenario.run_id} has status {run.response.status.code}: there is nothing to show")
    figure = new_figure(10.0, 7.2)
    grid = figure.add_gridspec(2, 2, width_ratios=[1, 1.25])
    orbit(figure.add_subplot(grid[0, 0]), run)
    waveform(figure.add_subplot(grid[0, 1]), run, "casing_acc_0")
    events, turns = run.response.events, run.response.record_turns
    ring = cast("PolarAxes", figure.add_subplot(grid[1, 0], projection="polar"))
    contact_map(ring, events.angle, events.impulse, turns)
    force_spectrum(figure.add_subplot(grid[1, 1]), run)
    return figure


def orbit(axes: Axes, run: Run) -> None:
    """Path of the disk centre over the last 30 turns and its position once a turn over the whole record."""
    taps, steps = run.response.taps, ORBIT_TURNS * run.response.steps_per_turn
    axes.plot(1e6 * taps["blisk_x"][-steps:], 1e6 * taps["blisk_y"][-steps:], color=BLUE, linewidth=0.6, alpha=0.8)
    centre = 3 * run.response.n_blades
    x, y = 1e6 * run.response.section_q[:, centre], 1e6 * run.response.section_q[:, centre + 1]
    axes.plot(x, y, ".", color=VERMILION, markersize=4, markeredgewidth=0, zorder=3)
    axes.set_aspect("equal")
    axes.margins(0.12)
    axes.locator_params(nbins=6)
    label_axes(axes, "Disk centre $x$, µm", "Disk centre $y$, µm")
    _section(axes.inset_axes((0.37, 0.39, 0.3, 0.3)), x - x.mean(), y - y.mean())


def _section(axes: Axes, x: FloatArray, y: FloatArray) -> None:
    """The section points about their mean, enlarged."""
    axes.plot(x, y, ".", color=VERMILION, markersize=3.5, markeredgewidth=0)
    half = 1.25 * max(float(np.abs(x).max()), float(np.abs(y).max()), 0.1)
    axes.set(xlim=(-half, half), ylim=(-half, half), aspect="equal")
    label_axes(axes, "once a turn, µm", "")
    axes.xaxis.label.set(fontsize=8, color=VERMILION)
    axes.tick_params(labelsize=7)
    axes.locator_params(nbins=3)


def waveform(axes: Axes, run: Run, name: str) -> None:
    """The last five turns of one recorded channel; vertical lines mark the turns."""
    if run.recording is None:
        raise ValueError("a waveform needs a recording")
    channel, rate = run.recording.channels[name], run.recording.sample_rate_hz
    count = min(channel.values.size, round(WAVE_TURNS * run.response.turn_seconds * rate))
    begin = (channel.values.size - count) / rate
    pulses = run.recording.once_per_rev[run.recording.once_per_rev >= begin] - begin
    axes.vlines(1e3 * pulses, 0, 1, color=PAPER_GREY, linewidth=1, transform=axes.get_xaxis_transform())
    axes.plot(1e3 * np.arange(count) / rate, channel.values[-count:], color=BLUE, linewidth=0.9)
    axes.margins(x=0)
    unit = channel.unit.replace("m/s2", "m/s²")
    label_axes(axes, "Time, ms (a line at every turn)", f"Casing acceleration at 0°, {unit}")


def force_spectrum(axes: Axes, run: Run) -> None:
    """Amplitudes of the total contact force over the order f / f_r, even orders marked."""
    spectrum = order_spectrum(run.response.taps["contact_force"], run.response)
    turns = spectrum_turns(run.response)
    stop = HIGHEST_ORDER * turns + turns // 2
    orders, amplitudes = np.arange(1, stop) / turns, spectrum[1:stop]
    label_axes(axes, "Order $f / f_r$", "Total contact force, N")
    axes.set_xlim(0, HIGHEST_ORDER + 0.5)
    axes.set_xticks(range(HIGHEST_ORDER + 1))
    if not amplitudes.any():
        axes.set_yticks([0])
        note(axes, "no contact")
        return
    floor = max(float(np.percentile(amplitudes, 1)) / 2, amplitudes.max() * 1e-5)
    axes.semilogy(orders, np.maximum(amplitudes, floor), color=BLUE, linewidth=0.9)
    label_axes(axes, "Order $f / f_r$", "Total contact force, N")
    whole = np.arange(1, HIGHEST_ORDER + 1)
    for parity, color, name in ((0, VERMILION, "even"), (1, GREY, "odd")):
        marked = whole[whole % 2 == parity]
        heights = np.where(spectrum[marked * turns] >= floor, spectrum[marked * turns], np.nan)
        axes.plot(marked, heights, "o", color=color, markersize=4.5, label=f"{name} orders")
    axes.set_ylim(floor, amplitudes.max() * 4)
    axes.legend(frameon=False, loc="lower right", bbox_to_anchor=(1, 0.98), fontsize=9, ncols=2, handletextpad=0.1)
