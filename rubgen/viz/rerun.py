"""One run as a Rerun recording (.rrd): a view made from the run, opened with `rerun FILE`."""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray
from rubgen.labels.labels import Motion
from rubgen.labels.plain import labels_dict
from rubgen.scenario.plain import scenario_dict
from rubgen.sensors.channel import Channel, Recording
from rubgen.sensors.contact_window import contact_intervals
from rubgen.sensors.envelope import min_max, preview_bin
from rubgen.viz.colors import MOTION_COLORS

if TYPE_CHECKING:  # importing rerun takes 0.6 s
    import rerun as rr

    from rubgen.labels.labels import Labels
    from rubgen.pipeline import Run
    from rubgen.scenario import Scenario

APPLICATION = "rubgen"
TIMELINE = "time"
DETAIL_TURNS = 20
BAR_WIDTH = 0.8
ENTITIES = ("/preview/", "/detail/", "/labels/motion", "/labels/text", "/__properties/labels")
Nanoseconds = npt.NDArray[np.timedelta64]


def write_rrd(run: Run, path: Path) -> None:
    """Write `run` to `path`, complete or not at all, with a default arrangement of views.

    Every channel as minimum and maximum at about 1 kHz (`/preview/<quantity>`) and at full rate over 20 turns around
    the hardest touch (`/detail/<quantity>`; the middle without contact); casing angle and impulse of every touch, the
    orbit with its section points, order amplitudes, motion classes, labels as text and as the property `labels`.
    Times are ns from the first sample. The bytes differ from writing to writing, the content does not.
    Raises ValueError for a run without a recording, OSError when the file cannot be written.
    """
    import rerun as rr

    from rubgen.viz.views import arrangement

    if run.recording is None or run.labels is None:
        raise ValueError(f"{run.scenario.run_id} has status {run.response.status.code}: there is nothing to show")
    part = path.with_name(f"{path.name}.part")
    stream = rr.RecordingStream(APPLICATION, recording_id=recording_id(run.scenario), send_properties=False)
    try:
        stream.save(part, default_blueprint=arrangement(run.recording, run.labels))
        stream.send_recording_name(run.scenario.run_id)
        _send_signals(stream, run, run.recording)
        _send_contacts(stream, run, run.recording)
        _send_orbit(stream, run, run.recording)
        _send_labels(stream, run.scenario, run.labels)
        stream.disconnect()
        _require_whole(part, path)
        part.replace(path)
    finally:
        stream.disconnect()
        part.unlink(missing_ok=True)


def check_rrd(path: Path) -> list[str]:
    """Problems of the recording at `path`, none for a good one: `rerun rrd verify`, and what `write_rrd` promises."""
    from rerun.chunk import RrdReader

    if not path.is_file():
        return [f"{path}: there is no such file"]
    command = [sys.executable, "-m", "rerun", "rrd", "verify", str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603 - our own interpreter
    if done.returncode != 0:
        lines = (done.stderr.strip() or done.stdout.strip() or "no reason given").splitlines()
        return [f"{path}: rerun rrd verify: {lines[-1]}"]
    try:
        entities = {chunk.entity_path for chunk in RrdReader(path).stream().to_chunks()}
    except RuntimeError as error:
        return [f"{path}: {error}"]
    return [f"{path}: no {name}" for name in ENTITIES if not any(entity.startswith(name) for entity in entities)]


def _require_whole(part: Path, path: Path) -> None:
    """Rerun writes in a thread of its own and only logs a full disk: a file whose footer is missing is an OSError."""
    from rerun.chunk import RrdReader
    from rerun.error_utils import RerunWarning

    try:
        with warnings.catch_warnings(action="error", category=RerunWarning):
            RrdReader(part).store()
    except (RerunWarning, RuntimeError, ValueError) as error:
        raise OSError(f"{path}: could not be written whole; is the disk full? ({error})") from None


def recording_id(scenario: Scenario) -> str:
    """Name of the run and a hash of its scenario: the same run has the same id, no two runs share one."""
    digest = hashlib.sha256(json.dumps(scenario_dict(scenario), sort_keys=True).encode()).hexdigest()
    return f"{scenario.run_id}-{digest[:12]}"


def detail_window(run: Run, recording: Recording) -> slice:
    """Samples of the 20 turns around the touch with the largest impulse, the middle of the recording without one."""
    samples = next(iter(recording.channels.values())).values.size
    length = min(samples, round(DETAIL_TURNS * run.response.turn_seconds * recording.sample_rate_hz))
    touches = contact_intervals(run.response, recording)
    centre = samples // 2
    if touches.impulse.size:
        centre = round(float(touches.start[np.argmax(touches.impulse)]) * recording.sample_rate_hz)
    first = min(max(centre - length // 2, 0), samples - length)
    return slice(first, first + length)


def quantities(recording: Recording) -> dict[str, list[Channel]]:
    """Channels by what they measure, in the order of the recording."""
    groups: dict[str, list[Channel]] = {}
    for channel in recording.channels.values():
        groups.setdefault(channel.quantity.replace(" ", "_"), []).append(channel)
    return groups


def _times(seconds: FloatArray) -> Nanoseconds:
    return np.round(seconds * 1e9).astype("timedelta64[ns]")


def _send_scalars(
    stream: rr.RecordingStream, entity: str, times: Nanoseconds, values: FloatArray, names: list[str]
) -> None:
    """Lines of one entity: `values` (n, len(names)). Spikes survive zooming out."""
    import rerun as rr

    lines = rr.SeriesLines(names=names, aggregation_policy=rr.components.AggregationPolicy.MinMax)
    stream.log(entity, lines, static=True)
    columns = rr.Scalars.columns(scalars=values.ravel()).partition([len(names)] * len(values))
    stream.send_columns(entity, [rr.TimeColumn(TIMELINE, duration=times)], columns)


def _send_signals(stream: rr.RecordingStream, run: Run, recording: Recording) -> None:
    rate = recording.sample_rate_hz
    step, window = preview_bin(rate), detail_window(run, recording)
    for quantity, group in quantities(recording).items():
        envelopes = [envelope for channel in group for envelope in min_max(channel.values, step)]
        names = [f"{channel.name}.{end} [{channel.unit}]" for channel in group for end in ("min", "max")]
        values = np.column_stack(envelopes).astype(np.float64)
        _send_scalars(stream, f"/preview/{quantity}", _times(np.arange(len(values)) * step / rate), values, names)
        values = np.column_stack([channel.values[window] for channel in group]).astype(np.float64)
        names = [f"{channel.name} [{channel.unit}]" for channel in group]
        _send_scalars(stream, f"/detail/{quantity}", _times(np.arange(window.start, window.stop) / rate), values, names)


def _send_contacts(stream: rr.RecordingStream, run: Run, recording: Recording) -> None:
    """Angle and impulse of every touch at its beginning, as points; nothing without contact."""
    import rerun as rr

    touches = contact_intervals(run.response, recording)
    if not touches.blade.size:
        return
    order = np.argsort(touches.start, kind="stable")
    index = [rr.TimeColumn(TIMELINE, duration=_times(np.maximum(touches.start[order], 0.0)))]
    for name, unit, values in (
        ("angle", "deg", np.degrees(touches.angle)),
        ("impulse", "N s", touches.impulse),
        ("blade", "number", touches.blade.astype(np.float64)),
    ):
        points = rr.SeriesPoints(names=f"{name} [{unit}]", markers="circle", marker_sizes=1.5, colors=[0, 114, 178])
        stream.log(f"/contact/{name}", points, static=True)
        stream.send_columns(f"/contact/{name}", index, rr.Scalars.columns(scalars=values[order]))


def _send_orbit(stream: rr.RecordingStream, run: Run, recording: Recording) -> None:
    """Path of the disk centre over the detail window and its section once a turn, in um."""
    import rerun as rr

    x, y = (recording.channels.get(f"proximity_{axis}") for axis in "xy")
    if x is not None and y is not None:
        window = detail_window(run, recording)
        path = 1e6 * np.column_stack([x.values[window], y.values[window]])
        stream.log(
            "/orbit/plane/path",
            rr.LineStrips2D([path], colors=[[0, 114, 178]], radii=rr.Radius.ui_points(0.75)),
            static=True,
        )
    centre = 3 * run.response.n_blades
    section = 1e6 * run.response.section_q[:, centre : centre + 2]
    upwards = rr.Transform3D(mat3x3=np.diag([1.0, -1.0, 1.0]))  # the viewer's 2D views have Y downwards
    stream.log("/orbit/plane", upwards, static=True)
    points = rr.Points2D(section, colors=[[213, 94, 0]], radii=rr.Radius.ui_points(2.5))
    stream.log("/orbit/plane/section", points, static=True)


def _send_labels(stream: rr.RecordingStream, scenario: Scenario, labels: Labels) -> None:
    import rerun as rr

    plain = labels_dict(labels)
    known: dict[str, Any] = {key: value for key, value in plain.items() if value not in (None, [])}
    stream.send_property("labels", rr.AnyValues(**known))
    stream.send_property("scenario", rr.AnyValues(json=json.dumps(scenario_dict(scenario))))
    stream.log("/labels/text", rr.TextDocument(_table(scenario, plain), media_type="text/markdown"), static=True)
    _send_motions(stream, labels)
    for tap, amplitudes in labels.orders.items():
        bars = rr.BarChart(amplitudes, abscissa=np.arange(1, 11) - BAR_WIDTH / 2, widths=np.full(10, BAR_WIDTH))
        stream.log(f"/orders/{tap}", bars, static=True)


def _send_motions(stream: rr.RecordingStream, labels: Labels) -> None:
    """One lane each for system, blisk and casing, every class in its colour."""
    import rerun as rr

    index = [rr.TimeColumn(TIMELINE, duration=_times(np.zeros(1)))]
    colors = [int(MOTION_COLORS[motion].lstrip("#") + "ff", 16) for motion in Motion]
    motions = {"system": labels.motion, "blisk": labels.motion_blisk, "casing": labels.motion_casing}
    for part, motion in motions.items():
        named = rr.StateConfiguration(
            values=[motion.value for motion in Motion],
            labels=[f"{part}: {motion.value}" for motion in Motion],
            colors=colors,
        )
        stream.log(f"/labels/motion/{part}", named, static=True)
        stream.send_columns(f"/labels/motion/{part}", index, rr.StateChange.columns(state=[motion.value]))


def _table(scenario: Scenario, plain: dict[str, object]) -> str:
    """Labels but for the order amplitudes, which have their own view, as Markdown."""
    rows = [f"| {key} | {_shown(value)} |" for key, value in plain.items() if not key.endswith("_orders")]
    title = f"# {scenario.run_id}: {scenario.machine.name} at {scenario.operation.speed_rpm:g} rev/min"
    return "\n".join([title, "", "| label | value |", "|---|---|", *rows])


def _shown(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, list):
        return ", ".join(_shown(item) for item in value) or "none"
    return "none" if value is None else str(value)
