"""Signals, contacts and orbit of a run as Rerun entities."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
import rerun as rr

from rubgen.arrays import FloatArray
from rubgen.sensors.channel import Recording
from rubgen.sensors.contact_window import contact_intervals
from rubgen.sensors.envelope import preview
from rubgen.viz.colors import BLUE, VERMILION, rgba

if TYPE_CHECKING:
    from rubgen.pipeline import Run

TIMELINE = "time"
DETAIL_TURNS = 20
Nanoseconds = npt.NDArray[np.timedelta64]


def detail_window(run: Run, recording: Recording) -> slice:
    """Samples of the 20 turns around the touch with the largest impulse, the middle of the recording without one."""
    samples = recording.samples
    length = min(samples, round(DETAIL_TURNS * run.response.turn_seconds * recording.sample_rate_hz))
    touches = contact_intervals(run.response, recording)
    centre = samples // 2
    if touches.impulse.size:
        centre = round(float(touches.start[np.argmax(touches.impulse)]) * recording.sample_rate_hz)
    first = min(max(centre - length // 2, 0), samples - length)
    return slice(first, first + length)


def times_ns(seconds: FloatArray) -> Nanoseconds:
    """Times as whole ns."""
    return np.round(seconds * 1e9).astype("timedelta64[ns]")


def _send_scalars(
    stream: rr.RecordingStream, entity: str, times: Nanoseconds, values: FloatArray, names: list[str]
) -> None:
    """Lines of one entity: `values` (n, len(names)). Spikes survive zooming out."""
    lines = rr.SeriesLines(names=names, aggregation_policy=rr.components.AggregationPolicy.MinMax)
    stream.log(entity, lines, static=True)
    columns = rr.Scalars.columns(scalars=values.ravel()).partition([len(names)] * len(values))
    stream.send_columns(entity, [rr.TimeColumn(TIMELINE, duration=times)], columns)


def send_signals(stream: rr.RecordingStream, run: Run, recording: Recording) -> None:
    """Every channel as preview and at full rate over the detail window, one entity a quantity."""
    rate = recording.sample_rate_hz
    window = detail_window(run, recording)
    for quantity, group in recording.by_quantity().items():
        shown = preview(group, rate)
        names = [f"{name} [{group[0].unit}]" for name in shown.names]
        _send_scalars(stream, f"/preview/{quantity}", times_ns(shown.first / rate), shown.values, names)
        values = np.column_stack([channel.values[window] for channel in group]).astype(np.float64)
        names = [f"{channel.name} [{channel.unit}]" for channel in group]
        _send_scalars(
            stream, f"/detail/{quantity}", times_ns(np.arange(window.start, window.stop) / rate), values, names
        )


def send_contacts(stream: rr.RecordingStream, run: Run, recording: Recording) -> None:
    """Angle and impulse of every touch at its beginning, as points; nothing without contact."""
    touches = contact_intervals(run.response, recording)
    if not touches.blade.size:
        return
    order = np.argsort(touches.start, kind="stable")
    index = [rr.TimeColumn(TIMELINE, duration=times_ns(np.maximum(touches.start[order], 0.0)))]
    for name, unit, values in (
        ("angle", "deg", np.degrees(touches.angle)),
        ("impulse", "N s", touches.impulse),
        ("blade", "number", touches.blade.astype(np.float64)),
    ):
        points = rr.SeriesPoints(names=f"{name} [{unit}]", markers="circle", marker_sizes=1.5, colors=rgba(BLUE))
        stream.log(f"/contact/{name}", points, static=True)
        stream.send_columns(f"/contact/{name}", index, rr.Scalars.columns(scalars=values[order]))


def send_orbit(stream: rr.RecordingStream, run: Run, recording: Recording) -> None:
    """Path of the disk centre over the detail window and its section once a turn, in um."""
    x, y = (recording.channels.get(f"proximity_{axis}") for axis in "xy")
    if x is not None and y is not None:
        window = detail_window(run, recording)
        path = 1e6 * np.column_stack([x.values[window], y.values[window]])
        stream.log(
            "/orbit/plane/path",
            rr.LineStrips2D([path], colors=rgba(BLUE), radii=rr.Radius.ui_points(0.75)),
            static=True,
        )
    centre = 3 * run.response.n_blades
    section = 1e6 * run.response.section_q[:, centre : centre + 2]
    upwards = rr.Transform3D(mat3x3=np.diag([1.0, -1.0, 1.0]))  # the viewer's 2D views have Y downwards
    stream.log("/orbit/plane", upwards, static=True)
    points = rr.Points2D(section, colors=rgba(VERMILION), radii=rr.Radius.ui_points(2.5))
    stream.log("/orbit/plane/section", points, static=True)
