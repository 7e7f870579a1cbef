"""Draw a run whose speed changes: spectra of the whirl over the speed, and the answer to the unbalance."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.errors import NoPictureError
from rubgen.units import rev_per_min
from rubgen.viz.colors import BLUE, VERMILION
from rubgen.viz.derived import shaft_orbit
from rubgen.viz.figures.style import head, label_axes, new_figure
from rubgen.viz.replay import Replay

DECIBELS = 80.0
BLOCK_TURNS = 16
SAMPLES_PER_TURN = 64
HIGHEST_ORDER = 6


def waterfall(replay: Replay, speeds_rpm: tuple[float, float] | None = None) -> Figure:
    """Draw full spectra of the orbit over the speed: forward orders to the right, backward orders to the left.

    Each line belongs to 16 turns at equal angles; up to 15 last turns are left out. A circle in the sense of rotation
    is order 1, a circle against it order -1. The first touch is marked, or a line of text says where it is.
    `speeds_rpm` is the shown range in rev/min; None shows all speeds. Raises ValueError as `whirl_by_turn` does.
    """
    speeds, turns = whirl_by_turn(replay)
    count = len(turns) // BLOCK_TURNS
    blocks = turns[: count * BLOCK_TURNS].reshape(count, -1)
    spectra = np.abs(np.fft.fft(blocks * np.hanning(blocks.shape[1]), axis=1)) / blocks.shape[1] * 2
    orders = np.fft.fftfreq(blocks.shape[1], 1 / SAMPLES_PER_TURN)
    shown = np.argsort(orders)
    shown = shown[np.abs(orders[shown]) <= HIGHEST_ORDER]
    largest = float(spectra.max()) or 1.0
    decibel = 20 * np.log10(np.maximum(spectra[:, shown] / largest, 10 ** (-DECIBELS / 20)))
    figure = new_figure(9.0, 5.4)
    axes = figure.subplots()
    middle = speeds[: count * BLOCK_TURNS].reshape(count, -1).mean(axis=1)
    mesh = axes.pcolormesh(orders[shown], middle, decibel, cmap="viridis", vmin=-DECIBELS, vmax=0, rasterized=True)
    figure.colorbar(mesh, ax=axes, pad=0.01).set_label(f"dB re {largest:.3g} µm", fontsize=10)
    label_axes(axes, "Order $f / f_r$ (backward on the left, forward on the right)", "Speed, rev/min")
    axes.set_xticks(range(-HIGHEST_ORDER, HIGHEST_ORDER + 1))
    axes.set_ylim(speeds_rpm)
    low, high = sorted(axes.get_ylim())
    onset, elsewhere = _first_touch(replay, (low, high))
    if onset is not None:
        axes.axhline(onset, color=VERMILION, linewidth=1.2)
        side = "top" if onset > (low + high) / 2 else "bottom"
        axes.text(-HIGHEST_ORDER, onset, " first touch", color="white", fontsize=9, va=side)
    head(figure, f"{replay.title}; {replay.headline}", elsewhere)
    return figure


def bode(replay: Replay, speeds_rpm: tuple[float, float] | None = None) -> Figure:
    """Draw amplitude and phase of the forward 1X whirl over the speed, turn by turn.

    The first touch is marked, or a line of text says where it is. The phase is the angle of the whirl from +X at the
    once-per-turn pulse, in the sense of rotation and in degrees: it falls where the whirl lags more. `speeds_rpm` is
    the shown range in rev/min; None shows all speeds. Raises ValueError as `whirl_by_turn` does.
    """
    speeds, turns = whirl_by_turn(replay)
    whirl = forward_1x(turns)
    figure = new_figure(9.0, 5.6)
    upper, lower = figure.subplots(2, 1, sharex=True)
    upper.plot(speeds, np.abs(whirl), color=BLUE, linewidth=0.9)
    lower.plot(speeds, np.degrees(np.unwrap(np.angle(whirl))), color=BLUE, linewidth=0.9)
    label_axes(upper, "", "Forward 1X, µm")
    label_axes(lower, "Speed, rev/min", "Phase, degrees")
    upper.set_xlim(speeds_rpm)
    low, high = sorted(upper.get_xlim())
    onset, elsewhere = _first_touch(replay, (low, high))
    if onset is not None:
        for axes in (upper, lower):
            _mark_onset(axes, onset)
    head(figure, f"{replay.title}; {replay.headline}", elsewhere)
    return figure


def whirl_by_turn(replay: Replay) -> tuple[FloatArray, ComplexArray]:
    """Return for each whole turn its speed in rev/min (turns,) and the orbit x + i y in µm at equal angles (turns, 64).

    Raises ValueError where no pair of proximity probes was recorded, the speed is steady, or there are fewer than 17
    pulses.
    """
    if replay.scenario.operation.profile == "steady":
        raise NoPictureError("the speed of this run is steady; choose a run-up or a coast-down")
    orbit = shaft_orbit(replay)
    if orbit is None:
        raise NoPictureError("no pair of proximity probes was recorded; choose sensors with two")
    pulses = replay.pulse_times
    if pulses.size <= BLOCK_TURNS:
        raise NoPictureError(f"signals of more than {BLOCK_TURNS} turns are needed; raise signal_seconds")
    share = np.arange(SAMPLES_PER_TURN) / SAMPLES_PER_TURN
    at = pulses[:-1, None] + share * np.diff(pulses)[:, None]
    time = np.arange(replay.recording.samples) / replay.recording.sample_rate_hz
    x, y = (np.interp(at, time, values) for values in orbit)
    speeds: FloatArray = 60 / np.diff(pulses)
    return speeds, x + 1j * y


def forward_1x(turns: ComplexArray) -> ComplexArray:
    """Return the complex amplitude of e^(i theta) in each turn (turns,) of an orbit (turns, samples)."""
    angle = 2 * np.pi * np.arange(turns.shape[1]) / turns.shape[1]
    amplitude: ComplexArray = turns @ np.exp(-1j * angle) / turns.shape[1]
    return amplitude


def _first_touch(replay: Replay, shown: tuple[float, float]) -> tuple[float | None, str]:
    """Return the speed of the first touch in rev/min if it is to be marked, and else a sentence that says where it is.

    It is not marked where it lies before the first sample, whatever its speed, or outside of the range `shown`.
    """
    labels: dict[str, Any] = replay.labels
    onset = labels["onset_speed_rpm"]
    if onset is None:
        return None, ""
    before, at = replay.recording.start_seconds - _time_of_first_touch(replay), f"at {onset:,.0f} rev/min"
    if before > 0:
        return None, f"The first touch lies before these signals: {before:.2f} s before they begin, {at}"
    if not shown[0] <= onset <= shown[1]:
        return None, f"The first touch lies outside of these speeds, {at}"
    return onset, ""


def _time_of_first_touch(replay: Replay) -> float:
    """Return its time from the start of the record, s: where the rub begins, or within the first turn of the record."""
    labels: dict[str, Any] = replay.labels
    changes = zip(labels["change_times_s"], labels["change_rub"], strict=True)
    begin = next(float(time) for time, rub in changes if rub)
    if begin > 0:
        return begin
    rotation = replay.scenario.operation.rotation
    turn = np.linspace(0, 2 * np.pi / rotation.start, SAMPLES_PER_TURN)
    return float(turn[np.argmin(np.abs(rev_per_min(rotation.speed(turn)) - labels["onset_speed_rpm"]))])


def _mark_onset(axes: Axes, onset: float) -> None:
    axes.axvline(onset, color=VERMILION, linewidth=1)
    axes.annotate(
        f"first touch, {onset:,.0f} rev/min", (onset, 0.03), xycoords=("data", "axes fraction"), xytext=(4, 0),
        textcoords="offset points", fontsize=8, color=VERMILION,
    )  # fmt: skip
