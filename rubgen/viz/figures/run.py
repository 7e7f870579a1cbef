"""Draw one run: its true response, or its recording, which needs no solver and works for files."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator

from rubgen.arrays import FloatArray
from rubgen.errors import NoPictureError
from rubgen.labels.harmonics import order_spectrum, spectrum_turns
from rubgen.labels.headline import headline
from rubgen.labels.to_json import labels_to_json
from rubgen.machine.problems import nearest
from rubgen.measurement.channel import Channel
from rubgen.viz.colors import BLUE, GREY, PAPER_GREY, VERMILION
from rubgen.viz.derived import HIGHEST_ORDER, order_map, poincare_section, sector_of, shaft_orbit
from rubgen.viz.figures.style import INK, head, label_axes, new_figure, note
from rubgen.viz.replay import Replay

if TYPE_CHECKING:
    from rubgen.pipeline import Run

ORBIT_TURNS = 30
OVERVIEW_TURNS, WAVE_TURNS = 5, 6
"""Turns of the waveform in the overview and in the figure of its own."""
USUAL = "casing_acc_0"
"""Channel of the waveform. Where a sensor set has none of this name, the overview shows its first channel."""
SECTORS = 90


def overview(run: Run) -> Figure:
    """Draw a run in four panels: orbit with section, casing acceleration, spectrum and polar map of the contact force.

    Orbit, spectrum and map show the true response. The acceleration is the recorded channel `casing_acc_0`; without it
    the first channel is drawn in its place. Raises ValueError for a run without a recording.
    """
    if run.recording is None:
        raise NoPictureError(f"{run.scenario.run_id} has status {run.response.status.code}: there is nothing to show")
    figure = new_figure(10.0, 7.2)
    grid = figure.add_gridspec(2, 2, width_ratios=[1, 1.25])
    _true_orbit(figure.add_subplot(grid[0, 0]), run)
    channels, seconds = run.recording.channels, OVERVIEW_TURNS * run.response.turn_seconds
    channel = channels.get(USUAL) or next(iter(channels.values()))
    what = f"Casing acceleration at 0°, {_unit(channel)}" if channel.name == USUAL else _named(channel)
    wave = figure.add_subplot(grid[0, 1])
    _waveform(wave, channel, run.recording.sample_rate_hz, run.recording.once_per_rev, seconds)
    label_axes(wave, "Time, ms (a line at every turn)", what)
    events, turns = run.response.events, run.response.record_turns
    ring = cast("PolarAxes", figure.add_subplot(grid[1, 0], projection="polar"))
    contact_map(ring, events.angle, events.impulse, turns)
    _force_spectrum(figure.add_subplot(grid[1, 1]), run)
    said = headline(labels_to_json(run.labels), run.scenario.operation.profile) if run.labels else ""
    scenario = run.scenario
    head(figure, f"{scenario.run_id}: {scenario.machine.name}, {scenario.operation.title}; {said}")
    return figure


def _true_orbit(axes: Axes, run: Run) -> None:
    """Draw the path of the disk centre over the last 30 turns and its position once a turn over the whole record."""
    taps, steps = run.response.taps, ORBIT_TURNS * run.response.steps_per_turn
    axes.plot(1e6 * taps["blisk_x"][-steps:], 1e6 * taps["blisk_y"][-steps:], color=BLUE, linewidth=0.6, alpha=0.8)
    centre = 3 * run.response.n_blades
    x, y = 1e6 * run.response.section_q[:, centre], 1e6 * run.response.section_q[:, centre + 1]
    axes.plot(x, y, ".", color=VERMILION, markersize=4, markeredgewidth=0, zorder=3)
    axes.set_aspect("equal")
    axes.margins(0.12)
    axes.locator_params(nbins=6)
    label_axes(axes, "Disk centre $x$, µm", "Disk centre $y$, µm")
    _enlarged(axes.inset_axes((0.37, 0.39, 0.3, 0.3)), x - x.mean(), y - y.mean())


def _enlarged(axes: Axes, x: FloatArray, y: FloatArray) -> None:
    """Draw the section points about their mean, enlarged."""
    axes.plot(x, y, ".", color=VERMILION, markersize=3.5, markeredgewidth=0)
    half = 1.25 * max(float(np.abs(x).max()), float(np.abs(y).max()), 0.1)
    axes.set(xlim=(-half, half), ylim=(-half, half), aspect="equal")
    label_axes(axes, "once a turn, µm", "")
    axes.xaxis.label.set(fontsize=8, color=VERMILION)
    axes.tick_params(labelsize=7)
    axes.locator_params(nbins=3)


def _waveform(axes: Axes, channel: Channel, rate: float, pulses: FloatArray, seconds: float) -> None:
    """Draw the last `seconds` of a recorded channel; vertical lines mark the turns."""
    count = min(channel.values.size, round(seconds * rate))
    begin = (channel.values.size - count) / rate
    turns = pulses[pulses >= begin] - begin
    axes.vlines(1e3 * turns, 0, 1, color=PAPER_GREY, linewidth=1, transform=axes.get_xaxis_transform())
    axes.plot(1e3 * np.arange(count) / rate, channel.values[-count:], color=BLUE, linewidth=0.9)
    axes.margins(x=0)


def _named(channel: Channel) -> str:
    return f"{channel.quantity[0].upper()}{channel.quantity[1:]}, {channel.location}, {_unit(channel)}"


def _unit(channel: Channel) -> str:
    return channel.unit.replace("m/s2", "m/s²")


def _floor(amplitudes: FloatArray) -> float:
    """Return the lower end of a logarithmic axis of amplitudes: 100 dB below the largest, or half of the noise."""
    return max(float(np.percentile(amplitudes, 1)) / 2, float(amplitudes.max()) * 1e-5)


def _force_spectrum(axes: Axes, run: Run) -> None:
    """Draw amplitudes of the total contact force over the order f / f_r, with even and odd orders marked."""
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
    floor = _floor(amplitudes)
    axes.semilogy(orders, np.maximum(amplitudes, floor), color=BLUE, linewidth=0.9)
    label_axes(axes, "Order $f / f_r$", "Total contact force, N")
    whole = np.arange(1, HIGHEST_ORDER + 1)
    for parity, color, name in ((0, VERMILION, "even"), (1, GREY, "odd")):
        marked = whole[whole % 2 == parity]
        heights = np.where(spectrum[marked * turns] >= floor, spectrum[marked * turns], np.nan)
        axes.plot(marked, heights, "o", color=color, markersize=4.5, label=f"{name} orders")
    axes.set_ylim(floor, amplitudes.max() * 4)
    axes.legend(frameon=False, loc="lower right", bbox_to_anchor=(1, 0.98), fontsize=9, ncols=2, handletextpad=0.1)


def orbit_section(replay: Replay) -> Figure:
    """Draw the recorded orbit of the disk centre over the last 30 turns, and the points once a turn, enlarged.

    The points once a turn, the Poincare section, are of the whole recording. Raises ValueError where no pair of
    proximity probes was recorded.
    """
    orbit, once = shaft_orbit(replay), poincare_section(replay)
    if orbit is None or once is None:
        raise NoPictureError("no pair of proximity probes was recorded; choose sensors with two")
    x, y = orbit
    time = np.arange(replay.recording.samples) / replay.recording.sample_rate_hz
    figure = new_figure(9.0, 4.4)
    path, points = figure.subplots(1, 2)
    last = time > time[-1] - ORBIT_TURNS * replay.turn_seconds
    path.plot(x[last], y[last], color=BLUE, linewidth=0.6)
    path.plot(*once, ".", color=VERMILION, markersize=4)
    points.plot(*once, ".", color=VERMILION, markersize=4)
    for axes, text in ((path, "orbit"), (points, "once a turn")):
        axes.set_aspect("equal", adjustable="datalim")
        axes.margins(0.1)
        label_axes(axes, "Disk centre $x$, µm", f"Disk centre $y$, µm ({text})")
    head(figure, f"{replay.title}; {replay.headline}")
    return figure


def contact_distribution(replay: Replay) -> Figure:
    """Draw the mean normal impulse per turn in mN s around the casing, in sectors of 4 degrees, and by blade.

    Without touches both are empty, and a note says "no contact".
    """
    touches, turns = replay.touches, max(replay.seconds / replay.turn_seconds, 1.0)
    figure = new_figure(10.0, 4.6)
    grid = figure.add_gridspec(1, 2, width_ratios=[1, 1.4])
    polar = cast("PolarAxes", figure.add_subplot(grid[0, 0], projection="polar"))
    bars = figure.add_subplot(grid[0, 1])
    contact_map(polar, touches.angle, touches.impulse, turns)
    blades = replay.scenario.machine.blades.count
    by_blade = 1e3 * np.bincount(touches.blade.astype(np.int64), weights=touches.impulse, minlength=blades) / turns
    bars.bar(np.arange(blades), by_blade, color=BLUE, width=0.8)
    bars.xaxis.set_major_locator(MaxNLocator(integer=True))
    label_axes(bars, "Blade", "Impulse a turn, mN s")
    if not by_blade.any():
        note(bars, "no contact")
    head(figure, f"{replay.title}; {replay.headline}")
    return figure


def waveform_orders(replay: Replay, name: str = USUAL) -> Figure:
    """Draw the channel `name` over its last six turns, and its order spectrum over the whole recording.

    Raises ValueError for a channel that was not recorded.
    """
    channel, rate = channel_of(replay, name), replay.recording.sample_rate_hz
    figure = new_figure(10.0, 4.0)
    wave, orders = figure.subplots(1, 2)
    _waveform(wave, channel, rate, replay.pulse_times, WAVE_TURNS * replay.turn_seconds)
    unit = _unit(channel)
    label_axes(wave, "Time, ms (a line at every turn)", _named(channel))
    found = order_map(channel.values, rate, replay.pulse_times, turns=replay.pulse_times.size)
    label_axes(orders, "Order $f / f_r$", f"Amplitude, {unit}")
    orders.set_xticks(range(HIGHEST_ORDER + 1))
    if found.amplitude.size and found.amplitude.any():
        amplitude = found.amplitude[0]
        floor = _floor(amplitude)
        orders.vlines(range(1, HIGHEST_ORDER + 1), floor, amplitude.max() * 2, color=PAPER_GREY, linewidth=0.8)
        orders.semilogy(found.order, np.maximum(amplitude, floor), color=BLUE, linewidth=0.9)
        orders.set_ylim(floor, 2 * amplitude.max())
    else:
        note(orders, "no whole turn")
    orders.spines["left"].set_color(GREY)
    head(figure, f"{replay.title}; {replay.headline}")
    return figure


def channel_of(replay: Replay, name: str) -> Channel:
    """Return the recorded channel called `name`. Raises ValueError, with similar names, where there is none."""
    channels = replay.recording.channels
    if name not in channels:
        raise NoPictureError(f"no channel {name!r}; {nearest(name, list(channels))}")
    return channels[name]


def contact_map(axes: PolarAxes, angle: FloatArray, impulse: FloatArray, turns: float) -> None:
    """Draw the normal impulse per turn around the casing as a polar histogram in sectors of 4 degrees, in mN s.

    - axes: polar axes to draw on.
    - angle (touches,): polar angle of each touch on the casing, rad.
    - impulse (touches,): impulse of each touch over all turns, N s.
    - turns: number of turns in which the touches occurred.

    Sector 0 is centred at 0.
    """
    width = 2 * np.pi / SECTORS
    per_turn = 1e3 * np.bincount(sector_of(angle, SECTORS), weights=impulse, minlength=SECTORS) / turns
    axes.bar(width * np.arange(SECTORS), per_turn, width=width, color=BLUE, linewidth=0, zorder=3)
    axes.set_xticks(np.radians(np.arange(0, 360, 45)))
    axes.tick_params(labelsize=9, colors=INK)
    axes.grid(color=PAPER_GREY, linewidth=0.7)
    axes.spines[["polar", "inner"]].set_color(GREY)
    axes.set_rlabel_position(112.5)
    axes.yaxis.set_major_locator(MaxNLocator(3))
    axes.set_xlabel(
        "Contact impulse in a turn and 4°, mN s, over the casing's angle", fontsize=10, color=INK, labelpad=8
    )
    if per_turn.any():
        axes.set_rorigin(-0.6 * per_turn.max())  # a ring: near a point no sector could be told from its neighbour
    else:
        axes.set_yticks([])
        note(axes, "no contact")
