"""Draw a moment of a replay as a picture, and the dense turns as an animation, without a screen or a viewer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from rubgen.arrays import FloatArray, IntArray
from rubgen.errors import NoPictureError
from rubgen.labels.labels import Motion
from rubgen.machine import Unbalance
from rubgen.measurement.motion import MotionFrames
from rubgen.progress import count
from rubgen.viz.colors import BLUE, GREY, MOTION_COLORS, PAPER_GREY, UNBALANCE, VERMILION, impulse_color
from rubgen.viz.derived import shaft_orbit
from rubgen.viz.entities.machine_shape import (
    blade_angles,
    casing_angles,
    casing_curve,
    drawing_factor,
    drawn_tips,
    unbalance_text,
    unbalances,
    undeformed_curve,
)
from rubgen.viz.figures.style import INK, label_axes, new_figure, note
from rubgen.viz.replay import Replay

if TYPE_CHECKING:
    from PIL import Image

NEAR_TURNS = 3.0
FRAMES_PER_TURN = 32
TRACE_TURNS = 1.0
PALETTE_FRAMES = 4
GIF_FRAMES, GIF_MILLISECONDS, GIF_DPI = 64, 80, 80
ARC = 360


@dataclass(frozen=True)
class _Scene:
    """The constant part of a scene."""

    replay: Replay
    frames: MotionFrames
    factor: float


def picture(replay: Replay, time: float | None = None) -> Figure:
    """Draw the machine seen along its axis, the orbit and the contact force at one moment.

    `time` is in s from the first sample; None is the time of the hardest touch. The machine is drawn in the nearest
    frame, and the picture shows the time of this frame. Raises NoPictureError, a ValueError, for a replay without
    frames, or a time outside the recording.
    """
    scene = _scene(replay)
    return _drawn(scene, _nearest(scene, replay.hardest_touch if time is None else time))


def write_gif(replay: Replay, path: Path) -> None:
    """Write an endless animation of the 64 dense frames about the hardest touch, which are two turns, to `path`.

    An existing file is replaced. Without dense frames it is of 64 frames about the same time; with fewer frames it is
    shorter. Raises NoPictureError, a ValueError, for a replay without frames.
    """
    from PIL import Image

    scene = _scene(replay)
    chosen = frames_about(scene.frames, replay.hardest_touch)
    drawn = [Image.fromarray(pixels) for pixels in _pixels(scene, chosen)]
    palette = _palette(drawn[:: max(1, len(drawn) // PALETTE_FRAMES)])
    images = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in drawn]
    images[0].save(
        path, format="GIF", save_all=True, append_images=images[1:], duration=GIF_MILLISECONDS, loop=0, optimize=True
    )


def frames_about(frames: MotionFrames, time: float) -> IntArray:
    """Return the numbers of GIF_FRAMES dense frames, or of all frames if none is dense, with `time` (s) in the middle.

    Fewer frames are returned only where there are fewer.
    """
    numbers = np.flatnonzero(frames.dense) if frames.dense.any() else np.arange(frames.time.size)
    middle = int(np.argmin(np.abs(frames.time[numbers] - time)))
    first = max(0, min(middle - GIF_FRAMES // 2, numbers.size - GIF_FRAMES))
    return numbers[first : first + GIF_FRAMES]


def _palette(images: list[Image.Image]) -> Image.Image:
    """Choose colours for all frames from some: moved towards means of clusters, so that rare colours remain."""
    from PIL import Image

    width, height = images[0].size
    strip = Image.new("RGB", (width, height * len(images)))
    for place, image in enumerate(images):
        strip.paste(image, (0, place * height))
    return strip.quantize(256, kmeans=2, dither=Image.Dither.NONE)


def _pixels(scene: _Scene, chosen: np.ndarray) -> Iterator[np.ndarray]:
    for done, row in enumerate(chosen):
        count(done, len(chosen))
        figure = _drawn(scene, int(row))
        figure.set_dpi(GIF_DPI)
        figure.canvas.draw()
        yield np.asarray(figure.canvas.buffer_rgba())[..., :3]  # type: ignore[attr-defined]


def _scene(replay: Replay) -> _Scene:
    frames = replay.frames
    if frames is None or not frames.time.size:
        raise NoPictureError(f"{replay.scenario.run_id} holds no motion, only signals; simulate it again")
    return _Scene(replay, frames, drawing_factor(replay.scenario.machine, frames))


def _nearest(scene: _Scene, time: float) -> int:
    seconds = scene.replay.seconds
    if not 0 <= time <= seconds:
        raise NoPictureError(f"time {time:g} s lies outside the recording; give 0 to {seconds:g}")
    return int(np.argmin(np.abs(scene.frames.time - time)))


def _drawn(scene: _Scene, row: int) -> Figure:
    figure = new_figure(10.0, 5.6)
    grid = figure.add_gridspec(2, 2, width_ratios=[1.25, 1])
    machine_along_axis(figure.add_subplot(grid[:, 0]), scene.replay, row, scene.factor)
    figure.suptitle(scene.replay.title, x=0.01, ha="left", fontsize=11, color=INK)
    motion = _motion_at(scene.replay, float(scene.frames.time[row]))
    figure.text(0.5, 0.9915, motion.value, ha="right", va="top", fontsize=11, color=MOTION_COLORS[motion])
    _orbit(figure.add_subplot(grid[0, 1]), scene, row)
    _force(figure.add_subplot(grid[1, 1]), scene, row)
    return figure


def _motion_at(replay: Replay, time: float) -> Motion:
    """Return the class of motion at a time, s."""
    known = [name for start, name in replay.motion_classes.get("motion", []) if start <= time]
    return Motion(known[-1] if known else str(replay.labels["motion"]))


def machine_along_axis(axes: Axes, replay: Replay, row: int, factor: float) -> None:
    """Draw frame number `row` of a replay, seen along the axis of rotation.

    It shows the casing at rest and deformed, the blisk, the unbalances, and the touches of this frame (large) and of
    the last turn (small). Deviations from the circle of the tips are enlarged by `factor`. The replay must have frames.
    """
    machine, frames = replay.scenario.machine, replay.frames
    assert frames is not None  # noqa: S101 - the caller has looked
    time, angle = float(frames.time[row]), float(frames.angle[row])
    one = _only(frames, row)
    around = np.append(casing_angles(ARC), 0.0)
    rest = undeformed_curve(machine, around, factor)
    curve = casing_curve(machine, one, around, factor, replay.closed[row : row + 1])[0]
    axes.plot(*rest.T, color=GREY, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1)
    axes.plot(*curve.T, color="#4a5a68", linewidth=4.5, solid_capstyle="round", zorder=3)
    centre = factor * np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]) @ one.centre[0]
    _blisk(axes, replay, centre, angle, drawn_tips(machine, one, factor)[0])
    _contacts(axes, replay, frames, row, curve)
    text = f"deviations from the tip circle × {factor:g}; t = {1e3 * time:.2f} ms"
    if replay.touches.impulse.size:
        text += "\ncontacts by impulse, the present ones large, those of the last turn small"
    axes.text(0.5, -0.01, text, transform=axes.transAxes, ha="center", va="top", fontsize=9, color=INK)
    reach = 1.04 * float(np.abs(rest).max())
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axes.axis("off")


def _only(frames: MotionFrames, row: int) -> MotionFrames:
    part = slice(row, row + 1)
    return MotionFrames(
        time=frames.time[part], angle=frames.angle[part], centre=frames.centre[part], tips=frames.tips[part],
        casing=frames.casing[part], dense=frames.dense[part], casing_modes=frames.casing_modes,
    )  # fmt: skip


def _blisk(axes: Axes, replay: Replay, centre: FloatArray, angle: float, tips: FloatArray) -> None:
    """Draw disk, blades as wide as their chord is seen along the axis, and the unbalances."""
    machine = replay.scenario.machine
    blades, rim = machine.blades, machine.disk.rim_radius_m
    turned = angle + blade_angles(blades)
    outward = np.column_stack([np.cos(turned), np.sin(turned)])
    across = np.column_stack([-np.sin(turned), np.cos(turned)])
    root, tip = (chord * abs(np.cos(np.radians(a))) / 2 + t / 2 for chord, a, t in (
        (blades.root_chord_m, blades.root_angle_deg, blades.root_thickness_m),
        (blades.tip_chord_m, blades.tip_angle_deg, blades.tip_thickness_m)))  # fmt: skip
    foot = centre + rim * outward
    corners = np.stack([foot - root * across, foot + root * across, tips + tip * across, tips - tip * across], axis=1)
    axes.add_collection(PolyCollection(list(corners), facecolor="#aebac5", edgecolor="white", linewidth=0.6, zorder=2))
    round_ = np.linspace(0, 2 * np.pi, ARC)
    circle = np.column_stack([np.cos(round_), np.sin(round_)])
    axes.fill(*(centre + rim * circle).T, color="#7d8a96", zorder=2)
    axes.fill(*(centre + machine.disk.bore_radius_m * circle).T, color="#d5dbe1", zorder=2)
    for each in unbalances(machine):
        _unbalance(axes, each, centre, angle, tips if each.blade is not None else rim)


def _unbalance(axes: Axes, each: Unbalance, centre: FloatArray, angle: float, place: FloatArray | float) -> None:
    """Draw an unbalance near the rim, `place` its radius, or at the tip of its blade, `place` the tips."""
    if isinstance(place, float):
        turned = angle + np.radians(each.angle_deg or 0.0)
        mark = centre + 0.88 * place * np.array([np.cos(turned), np.sin(turned)])
        inside = centre + 0.6 * (mark - centre)
    else:
        mark = place[each.blade or 0]
        inside = centre + 0.48 * (mark - centre)
    axes.plot(*mark, "o", color=UNBALANCE, markersize=9, markeredgecolor="white", markeredgewidth=0.8, zorder=7)
    text = unbalance_text(each).replace(" ", "\n", 1)
    axes.text(float(inside[0]), float(inside[1]), text, ha="center", va="center", fontsize=7.5, color="white", zorder=4)


def _contacts(axes: Axes, replay: Replay, frames: MotionFrames, row: int, curve: FloatArray) -> None:
    """Draw touches of the last turn small and touches of this frame large, both by impulse."""
    touches = replay.touches
    if not touches.impulse.size:
        return
    start = float(frames.time[row])
    end = start + replay.turn_seconds / FRAMES_PER_TURN
    share = np.sqrt(touches.impulse / touches.impulse.max())
    last = touches.start + touches.duration
    place = np.mod(np.round(touches.angle * ARC / (2 * np.pi)).astype(int), ARC)
    for chosen, size, z in (
        ((touches.start < end) & (last > start - TRACE_TURNS * replay.turn_seconds), 25.0, 5),
        ((touches.start < end) & (last > start), 260.0, 6),
    ):
        x, y = curve[place[chosen]].T
        named = [f"#{value >> 8:06x}" for value in impulse_color(share[chosen]).tolist()]
        axes.scatter(x, y, s=size * (0.15 + share[chosen]), c=named, zorder=z, linewidth=0.5, edgecolor="white")


def _orbit(axes: Axes, scene: _Scene, row: int) -> None:
    """Draw the recorded path of the last turns, points once a turn, and the present disk centre."""
    replay, time = scene.replay, float(scene.frames.time[row])
    label_axes(axes, "Disk centre $x$, µm", "Disk centre $y$, µm")
    orbit = shaft_orbit(replay)
    if orbit is None:
        note(axes, "no pair of proximity probes")
        return
    x, y = orbit
    samples = np.arange(replay.recording.samples) / replay.recording.sample_rate_hz
    near = (samples > time - 10 * replay.turn_seconds) & (samples <= time)
    axes.plot(x[near], y[near], color=BLUE, linewidth=0.7, alpha=0.8)
    once = replay.pulse_times
    axes.plot(np.interp(once, samples, x), np.interp(once, samples, y), ".", color=VERMILION, markersize=3)
    axes.plot(np.interp(time, samples, x), np.interp(time, samples, y), "o", color="black", markersize=5)
    half = 0.6 * max(float(np.nanmax(x) - np.nanmin(x)), float(np.nanmax(y) - np.nanmin(y)), 1.0)
    middle = [float(np.nanmax(v) + np.nanmin(v)) / 2 for v in (x, y)]
    axes.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half), aspect="equal")
    axes.locator_params(nbins=5)


def _force(axes: Axes, scene: _Scene, row: int) -> None:
    """Draw the recorded contact force three turns before and after."""
    replay, time = scene.replay, float(scene.frames.time[row])
    label_axes(axes, "Time, ms (a line at every turn)", "Contact force, kN")
    channel = replay.recording.channels.get("contact_force")
    if channel is None:
        note(axes, "no contact force recorded")
        return
    rate = replay.recording.sample_rate_hz
    first, last = (round((time + sign * NEAR_TURNS * replay.turn_seconds) * rate) for sign in (-1, 1))
    part = slice(max(first, 0), min(last, channel.values.size))
    pulses = replay.pulse_times
    axes.vlines(1e3 * pulses, 0, 1, color=PAPER_GREY, linewidth=1, transform=axes.get_xaxis_transform())
    axes.plot(1e3 * np.arange(part.start, part.stop) / rate, 1e-3 * channel.values[part], color=BLUE, linewidth=0.9)
    axes.axvline(1e3 * time, color="black", linewidth=1)
    axes.set_xlim(1e3 * first / rate, 1e3 * last / rate)
    top = 1e-3 * float(np.nanmax(channel.values))
    axes.set_ylim(min(-0.05 * top, -0.1), max(1.05 * top, 1.0))
