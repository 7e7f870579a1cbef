"""Figures of one run from what was recorded: they need no solver and work for files."""

from typing import cast

import numpy as np
from matplotlib.figure import Figure
from matplotlib.projections.polar import PolarAxes

from rubgen.machine.problems import nearest
from rubgen.measurement.channel import Channel
from rubgen.viz.colors import BLUE, GREY, PAPER_GREY, VERMILION
from rubgen.viz.figures.contact_map import contact_map
from rubgen.viz.figures.style import label_axes, new_figure, note
from rubgen.viz.orders import HIGHEST_ORDER, order_map
from rubgen.viz.replay import Replay
from rubgen.viz.shaft_orbit import section, shaft_orbit

WAVE_TURNS = 6


def orbit_section(replay: Replay) -> Figure:
    """The recorded orbit of the disk centre over the last 30 turns, and its points once a turn, enlarged.

    Raises ValueError where the probes were not recorded.
    """
    orbit, once = shaft_orbit(replay), section(replay)
    if orbit is None or once is None:
        raise ValueError("no pair of proximity probes was recorded; choose sensors with two")
    x, y = orbit
    time = np.arange(replay.recording.samples) / replay.recording.sample_rate_hz
    figure = new_figure(9.0, 4.4)
    path, points = figure.subplots(1, 2)
    last = time > time[-1] - 30 * replay.turn_seconds
    path.plot(x[last], y[last], color=BLUE, linewidth=0.6)
    path.plot(*once, ".", color=VERMILION, markersize=4)
    points.plot(*once, ".", color=VERMILION, markersize=4)
    for axes, text in ((path, "orbit"), (points, "once a turn")):
        axes.set_aspect("equal", adjustable="datalim")
        axes.margins(0.1)
        label_axes(axes, "Disk centre $x$, µm", f"Disk centre $y$, µm ({text})")
    return figure


def contact_distribution(replay: Replay) -> Figure:
    """Normal impulse around the casing, in sectors of 4 degrees, and by blade, a turn on average."""
    touches, turns = replay.touches, max(replay.seconds / replay.turn_seconds, 1.0)
    figure = new_figure(10.0, 4.6)
    grid = figure.add_gridspec(1, 2, width_ratios=[1, 1.4])
    polar = cast("PolarAxes", figure.add_subplot(grid[0, 0], projection="polar"))
    bars = figure.add_subplot(grid[0, 1])
    contact_map(polar, touches.angle, touches.impulse, turns)
    blades = replay.scenario.machine.blades.count
    by_blade = 1e3 * np.bincount(touches.blade.astype(np.int64), weights=touches.impulse, minlength=blades) / turns
    bars.bar(np.arange(blades), by_blade, color=BLUE, width=0.8)
    label_axes(bars, "Blade", "Impulse a turn, mN s")
    if not by_blade.any():
        note(bars, "no contact")
    return figure


def waveform_orders(replay: Replay, name: str = "casing_acc_0") -> Figure:
    """A channel over its last six turns, and its order spectrum over the whole recording.

    Raises ValueError for a channel that was not recorded.
    """
    channel, rate = channel_of(replay, name), replay.recording.sample_rate_hz
    figure = new_figure(10.0, 4.0)
    wave, orders = figure.subplots(1, 2)
    count = min(channel.values.size, round(WAVE_TURNS * replay.turn_seconds * rate))
    begin = (channel.values.size - count) / rate
    pulses = replay.pulse_times[replay.pulse_times >= begin] - begin
    wave.vlines(1e3 * pulses, 0, 1, color=PAPER_GREY, linewidth=1, transform=wave.get_xaxis_transform())
    wave.plot(1e3 * np.arange(count) / rate, channel.values[-count:], color=BLUE, linewidth=0.9)
    wave.margins(x=0)
    unit = channel.unit.replace("m/s2", "m/s²")
    what = f"{channel.quantity[0].upper()}{channel.quantity[1:]}, {channel.location}, {unit}"
    label_axes(wave, "Time, ms (a line at every turn)", what)
    found = order_map(channel.values, rate, replay.pulse_times, turns=replay.pulse_times.size)
    label_axes(orders, "Order $f / f_r$", f"Amplitude, {unit}")
    orders.set_xticks(range(HIGHEST_ORDER + 1))
    if found.amplitude.size and found.amplitude.any():
        amplitude = found.amplitude[0]
        floor = max(float(np.percentile(amplitude, 1)) / 2, float(amplitude.max()) * 1e-5)
        orders.vlines(range(1, HIGHEST_ORDER + 1), floor, amplitude.max() * 2, color=PAPER_GREY, linewidth=0.8)
        orders.semilogy(found.order, np.maximum(amplitude, floor), color=BLUE, linewidth=0.9)
        orders.set_ylim(floor, 2 * amplitude.max())
    else:
        note(orders, "no whole turn")
    orders.spines["left"].set_color(GREY)
    return figure


def channel_of(replay: Replay, name: str) -> Channel:
    """The recorded channel of that name; ValueError, with the names there are, where there is none."""
    channels = replay.recording.channels
    if name not in channels:
        raise ValueError(f"no channel {name!r}; {nearest(name, list(channels))}")
    return channels[name]
