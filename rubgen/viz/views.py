"""Arrange the views of a replay in the Rerun viewer."""

from collections.abc import Sequence

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from rubgen.measurement.channel import Channel, quantity_key
from rubgen.sensors.kinds.proximity import Proximity
from rubgen.sensors.sensor import SampledSensor
from rubgen.viz.entities.machine_shape import drawing_factor
from rubgen.viz.entities.orbit import Bounds, orbit_bounds, section_bounds
from rubgen.viz.entities.orders import spectrum_channels
from rubgen.viz.entities.signals import TIMELINE, UNSHOWN, detail_window
from rubgen.viz.replay import Replay

NEAR_TURNS, ORBIT_TURNS = 4.0, 10.0
SHADE = np.uint32(0x80808066)
"""Colour of the preview behind the samples."""
MOST_NAMES = 8
"""Longer legends hide the lines."""
ORBIT = ["$origin/**", "- /orbit/plane/scale/section"]
"""Path, points once a turn, and the scale of the path."""
PLAYBACK = 0.02
"""Speed of playback: a turn of 6 ms takes 0.3 s."""


def arrangement(replay: Replay, *, full: bool = False) -> rrb.Blueprint:
    """Arrange the views: machine and motion on the left, signals in the middle, orbit, orders and labels right.

    `full` is whether the recording has every sample.
    """
    parts = [
        rrb.Vertical(*_machine(replay), _motion(), row_shares=[4, 1]) if _has_frames(replay) else _motion(),
        rrb.Vertical(*_signals(replay, full=full), row_shares=[3, 3, 3]),
        rrb.Vertical(_orbits(replay), _orders(replay), _texts(), row_shares=[3, 3, 3]),
    ]
    return rrb.Blueprint(
        rrb.Horizontal(*parts, column_shares=[4, 4, 3] if _has_frames(replay) else [1, 4, 3]),
        _time_panel(replay),
        rrb.SelectionPanel(state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
        auto_views=False,
    )


def previews(sensors: Sequence[SampledSensor]) -> tuple[rrb.View, ...]:
    """Return small views of a run for a table of runs: the orbit, and previews of channels over time.

    The orbit has all drawn turns. This view is left out without two proximity probes. The channels are the
    accelerations; without one, the channels of the first sensor's quantity. Of several units the first is shown
    (`Recording.by_quantity`). `sensors` are the sensors of the recordings that are shown, at least one.
    """
    hidden = rrb.PlotLegend(visible=False)
    keys = [quantity_key(sensor.description.quantity) for sensor in sensors]
    chosen = "acceleration" if "acceleration" in keys else keys[0]
    series = rrb.TimeSeriesView(origin=f"/preview/{chosen}", name=chosen.replace("_", " "), plot_legend=hidden)
    if sum(isinstance(sensor, Proximity) for sensor in sensors) < 2:
        return (series,)
    ever = rrb.TimeRangeBoundary.infinite()
    whole = rrb.VisibleTimeRange(TIMELINE, start=ever, end=ever)
    return (rrb.Spatial2DView(origin="/orbit", contents=ORBIT, name="orbit", time_ranges=whole), series)


def _has_frames(replay: Replay) -> bool:
    return replay.frames is not None and replay.frames.time.size > 0


def _near(replay: Replay, before: float, after: float = 0.0) -> tuple[rr.TimeRangeBoundary, rr.TimeRangeBoundary]:
    """Return the range of time from `before` turns before to `after` turns after the cursor."""
    turn = replay.turn_seconds
    return (
        rrb.TimeRangeBoundary.cursor_relative(seconds=-before * turn),
        rrb.TimeRangeBoundary.cursor_relative(seconds=after * turn),
    )


def _machine(replay: Replay) -> list[rrb.Tabs]:
    """Return views of the machine in the inertial frame and in the turning frame."""
    machine = replay.scenario.machine
    factor = drawing_factor(machine, replay.frames)
    start, end = _near(replay, 1.0)
    trace = rrb.VisibleTimeRanges([rrb.VisibleTimeRange(TIMELINE, start=start, end=end)])
    eye = rrb.EyeControls3D(
        position=[0.75 * machine.tip_radius_m, 0.45 * machine.tip_radius_m, 2.9 * machine.tip_radius_m],
        look_target=[0.0, 0.0, 0.0],
        eye_up=[0.0, 1.0, 0.0],
    )
    views = [
        rrb.Spatial3DView(
            origin=origin,
            contents="/machine/**",
            name=f"{name}, deviations × {factor:g}",
            eye_controls=eye,
            line_grid=False,
            overrides={"/machine/contact/trace": trace},
        )
        for origin, name in (("/machine", "machine"), ("/machine/rotor", "turning with the blisk"))
    ]
    return [rrb.Tabs(*views)]


def _motion() -> rrb.StateTimelineView:
    return rrb.StateTimelineView(origin="/labels/motion", name="motion")


def _signals(replay: Replay, *, full: bool) -> list[rrb.Tabs]:
    """Return views of the whole run, and of a few turns around the cursor with every sample near the hardest touch.

    Where not every sample is there, the name of a near view says between which times they are.
    """
    start, end = _near(replay, NEAR_TURNS, NEAR_TURNS)
    near = rrb.TimeAxis(view_range=rrb.TimeRange(start=start, end=end))
    groups = {name: group for name, group in replay.recording.by_quantity().items() if name != UNSHOWN}
    titles = {quantity: f"{quantity.replace('_', ' ')}, {group[0].unit}" for quantity, group in groups.items()}
    window, rate = detail_window(replay), replay.recording.sample_rate_hz
    samples = f"; samples {window.start / rate:.3f} to {window.stop / rate:.3f} s, else preview"
    whole_run = full or window.stop - window.start == replay.recording.samples
    near_titles = {quantity: f"near: {title}{'' if whole_run else samples}" for quantity, title in titles.items()}
    whole = [
        rrb.TimeSeriesView(origin=f"/preview/{quantity}", name=title, plot_legend=_legend(groups[quantity], 2))
        for quantity, title in titles.items()
    ]
    close = [
        rrb.TimeSeriesView(
            origin=f"/detail/{quantity}",
            contents=[f"/preview/{quantity}", f"/detail/{quantity}"],
            name=near_titles[quantity],
            axis_x=near,
            plot_legend=_legend(groups[quantity], 3),
            overrides={f"/preview/{quantity}": rr.SeriesLines(colors=np.full(2 * len(groups[quantity]), SHADE))},
        )
        for quantity in titles
    ]
    return [
        rrb.Tabs(*whole, name="whole run", active_tab=titles.get("contact_force", 0)),
        rrb.Tabs(*close, name="about the cursor", active_tab=near_titles.get("acceleration", 0)),
        _contacts(replay),
    ]  # fmt: skip


def _legend(group: list[Channel], lines: int) -> rrb.PlotLegend | None:
    """Return None for the viewer's own legend; hidden where it would be long: names also appear under the cursor."""
    return rrb.PlotLegend(visible=False) if len(group) * lines > MOST_NAMES else None


def _contacts(replay: Replay) -> rrb.Tabs:
    return rrb.Tabs(
        rrb.TimeSeriesView(origin="/contact/angle", name="casing angle of contact, deg"),
        rrb.TimeSeriesView(origin="/contact/impulse", name="impulse, N s"),
        rrb.TimeSeriesView(origin="/contact/blade", name="blade"),
        rrb.TensorView(
            origin="/contact/map",
            name="impulse, mN s, by angle and blade",
            scalar_mapping=rrb.TensorScalarMapping(colormap="inferno"),
            view_fit="fill",
        ),
        *_timing(replay),
        name="contact",
    )


def _timing(replay: Replay) -> list[rrb.TimeSeriesView]:
    """Return a view of the deflections from blade tip timing, where there are any."""
    if not replay.recording.tip_timing:
        return []
    return [rrb.TimeSeriesView(origin="/blade_tip_timing", name="tip deflection from timing, um")]


def _orbits(replay: Replay) -> rrb.Tabs:
    """Return views of the orbit of the last turns with all points once a turn, and of these points enlarged."""
    start, end = _near(replay, ORBIT_TURNS)
    orbit = rrb.Spatial2DView(
        origin="/orbit",
        contents=ORBIT,
        name="orbit of the disk centre",
        visual_bounds=_square(orbit_bounds(replay)),
        time_ranges=rrb.VisibleTimeRange(TIMELINE, start=start, end=end),
    )
    section = rrb.Spatial2DView(
        origin="/orbit",
        contents=["/orbit/plane", "/orbit/plane/section", "/orbit/plane/scale/section"],
        name="once a turn, enlarged",
        visual_bounds=_square(section_bounds(replay)),
    )
    return rrb.Tabs(orbit, section, name="orbit", active_tab=0)


def _square(bounds: Bounds) -> rrb.VisualBounds2D:
    """Return the bounds with Y upward: in the viewer it points downward."""
    x, y, half = bounds.x, -bounds.y, bounds.half
    return rrb.VisualBounds2D(x_range=[x - half, x + half], y_range=[y - half, y + half])


def _orders(replay: Replay) -> rrb.Tabs:
    """Return views of spectra at the cursor and waterfalls over the run; a waterfall first where the speed changes."""
    channels = spectrum_channels(replay)
    spectra = [
        rrb.BarChartView(origin=f"/spectrum/{name}", name=f"{name}, {channel.unit}, over order")
        for name, channel in channels.items()
    ]
    falls = [
        rrb.TensorView(
            origin=f"/waterfall/{name}",
            name=f"waterfall: {name}, dB",
            scalar_mapping=rrb.TensorScalarMapping(colormap="viridis"),
            view_fit="fill",
        )
        for name in channels
    ]
    steady = replay.scenario.operation.rotation.is_steady
    first = (
        0
        if steady or not falls
        else len(spectra) + (list(channels).index("casing_acc_0") if "casing_acc_0" in channels else 0)
    )
    return rrb.Tabs(*spectra, *falls, name="orders", active_tab=first)


def _texts() -> rrb.Tabs:
    return rrb.Tabs(
        rrb.TextDocumentView(origin="/labels/text", name="labels"),
        rrb.TextDocumentView(origin="/labels/scenario", name="scenario"),
        name="text",
    )


def _time_panel(replay: Replay) -> rrb.TimePanel:
    """Return the time panel: paused at the start of the dense turns, which play slowly in a loop."""
    frames = replay.frames
    if frames is None or not frames.dense.any():
        return rrb.TimePanel(state="collapsed", timeline=TIMELINE)
    dense = frames.time[frames.dense == 1]
    selected = rrb.components.AbsoluteTimeRange(round(1e9 * dense[0]), round(1e9 * dense[-1]))
    return rrb.TimePanel(
        state="collapsed",
        timeline=TIMELINE,
        playback_speed=PLAYBACK,
        play_state="playing",
        loop_mode="selection",
        time_selection=selected,
    )
