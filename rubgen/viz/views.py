"""How the Rerun viewer arranges a replay."""

from __future__ import annotations

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from rubgen.viz.machine_shape import drawing_factor
from rubgen.viz.order_entities import spectrum_channels
from rubgen.viz.replay import Replay
from rubgen.viz.signal_entities import TIMELINE

FIRST = ("contact_force", "casing_acc_0", "proximity_x", "blisk_x")
"""What is looked at first; each view costs the file 8 kB, so orders are shown of these alone."""
NEAR_TURNS, ORBIT_TURNS = 4.0, 10.0
PLAYBACK = 0.02
"""A turn of 6 ms takes 0.3 s."""


def arrangement(replay: Replay) -> rrb.Blueprint:
    """Machine and motion on the left, signals in the middle, orbit, orders and labels on the right."""
    parts = [
        rrb.Vertical(*_machine(replay), _motion(), row_shares=[4, 1]) if _has_frames(replay) else _motion(),
        rrb.Vertical(*_signals(replay), row_shares=[3, 3, 3]),
        rrb.Vertical(_orbit(replay), _orders(replay), _texts(), row_shares=[3, 3, 3]),
    ]
    return rrb.Blueprint(
        rrb.Horizontal(*parts, column_shares=[4, 4, 3] if _has_frames(replay) else [1, 4, 3]),
        _time_panel(replay),
        rrb.SelectionPanel(state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
        auto_views=False,
    )


def _has_frames(replay: Replay) -> bool:
    return replay.frames is not None and replay.frames.time.size > 0


def _near(replay: Replay, before: float, after: float = 0.0) -> tuple[rr.TimeRangeBoundary, rr.TimeRangeBoundary]:
    """So many turns before and after the cursor."""
    turn = replay.turn_seconds
    return (
        rrb.TimeRangeBoundary.cursor_relative(seconds=-before * turn),
        rrb.TimeRangeBoundary.cursor_relative(seconds=after * turn),
    )


def _machine(replay: Replay) -> list[rrb.Tabs]:
    """The same machine seen from the ground and from the turning blisk."""
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
            name=f"{name}; deviations from the tip circle x {factor:g}",
            eye_controls=eye,
            line_grid=False,
            overrides={"/machine/contact/trace": trace},
        )
        for origin, name in (("/machine", "machine"), ("/machine/rotor", "from the turning blisk"))
    ]
    return [rrb.Tabs(*views)]


def _motion() -> rrb.StateTimelineView:
    return rrb.StateTimelineView(origin="/labels/motion", name="motion")


def _signals(replay: Replay) -> list[rrb.Tabs]:
    start, end = _near(replay, NEAR_TURNS, NEAR_TURNS)
    near = rrb.TimeAxis(view_range=rrb.TimeRange(start=start, end=end))
    groups = {name: group for name, group in replay.recording.by_quantity().items() if name != "pulse"}
    tabs = []
    for rate, title, first, axis in (
        ("preview", "whole run", "contact_force", None),
        ("detail", "about the cursor", "acceleration", near),
    ):
        names = {quantity: f"{quantity}, {group[0].unit} ({title})" for quantity, group in groups.items()}
        views = [
            rrb.TimeSeriesView(origin=f"/{rate}/{quantity}", name=name, axis_x=axis) for quantity, name in names.items()
        ]
        tabs.append(rrb.Tabs(*views, name=title, active_tab=names.get(first, 0)))
    return [*tabs, _contacts(replay)]


def _contacts(replay: Replay) -> rrb.Tabs:
    return rrb.Tabs(
        rrb.TimeSeriesView(origin="/contact/angle", name="casing angle of contact, deg"),
        rrb.TimeSeriesView(origin="/contact/impulse", name="impulse, N s"),
        rrb.TimeSeriesView(origin="/contact/blade", name="blade"),
        rrb.TensorView(
            origin="/contact/map",
            name="impulse, mN s: angle against blade",
            scalar_mapping=rrb.TensorScalarMapping(colormap="inferno"),
            view_fit="fill",
        ),
        *_timing(replay),
        name="contact",
    )


def _timing(replay: Replay) -> list[rrb.TimeSeriesView]:
    """A view of the deflections from blade tip timing, where there are any."""
    if not replay.recording.tip_timing:
        return []
    return [rrb.TimeSeriesView(origin="/blade_tip_timing", name="tip deflection from timing, um")]


def _orbit(replay: Replay) -> rrb.Spatial2DView:
    start, end = _near(replay, ORBIT_TURNS)
    found = [replay.recording.channels.get(name) for name in ("proximity_x", "proximity_y")]
    x, y = (np.zeros(1) if channel is None else 1e6 * channel.values for channel in found)
    half = 0.6 * max(*(float(np.nanmax(v) - np.nanmin(v)) for v in (x, y)), 1.0)
    middle_x, middle_y = (float(np.nanmax(v) + np.nanmin(v)) / 2 for v in (x, -y))  # Y points downwards in the viewer
    return rrb.Spatial2DView(
        origin="/orbit",
        name="orbit of the disk centre, um: last 10 turns; points once a turn",
        visual_bounds=rrb.VisualBounds2D(
            x_range=[middle_x - half, middle_x + half], y_range=[middle_y - half, middle_y + half]
        ),
        time_ranges=rrb.VisibleTimeRange(TIMELINE, start=start, end=end),
    )


def _orders(replay: Replay) -> rrb.Tabs:
    channels = spectrum_channels(replay)
    first = [name for name in FIRST if name in channels] or list(channels)[:1]
    spectra = [
        rrb.BarChartView(origin=f"/spectrum/{name}", name=f"{name}, {channels[name].unit}, over order")
        for name in first
    ]
    falls = [
        rrb.TensorView(
            origin=f"/waterfall/{name}",
            name=f"waterfall of {name}, dB",
            scalar_mapping=rrb.TensorScalarMapping(colormap="viridis"),
            view_fit="fill",
        )
        for name in first
    ]
    return rrb.Tabs(*spectra, *falls, name="orders", active_tab=0)


def _texts() -> rrb.Tabs:
    return rrb.Tabs(
        rrb.TextDocumentView(origin="/labels/text", name="labels"),
        rrb.TextDocumentView(origin="/labels/scenario", name="scenario"),
        name="text",
    )


def _time_panel(replay: Replay) -> rrb.TimePanel:
    """Paused at the beginning of the dense turns, which play in a loop, slowly."""
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
