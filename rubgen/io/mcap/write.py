"""Writing of one run as one MCAP file: every sample, a preview for plots, contacts, labels and scenario."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from operator import itemgetter
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from mcap.writer import Writer

from rubgen.io.files import write_durably
from rubgen.io.mcap.content import TIMING
from rubgen.io.mcap.foxglove import SCHEMA, SCHEMA_NAME, TRANSFORM, multi_arrays, transform, transform_descriptor_set
from rubgen.io.mcap.messages import (
    CONTACT_FIELDS,
    MESSAGES,
    PACKAGE,
    file_descriptor_set,
    message_class,
    sample_block,
    timestamp,
)
from rubgen.labels.to_json import labels_to_json, motion_classes
from rubgen.measurement.blade_tip_timing import TipTimes
from rubgen.measurement.channel import NUMBERS, TEXTS, Channel, Float32Array, Preview, Recording, preview
from rubgen.measurement.motion import MotionFrames, contact_intervals, motion_frames
from rubgen.scenario.scenario import scenario_dict

if TYPE_CHECKING:  # Run carries the solver's imports; who reads or checks a file needs none of them
    from rubgen.labels.labels import Labels
    from rubgen.pipeline import Run

LIBRARY = "rubgen"  # no version: the same run gives the same bytes
BLOCK_SAMPLES = 1024
CHUNK_BYTES = 512 * 1024
Stamped = tuple[int, bytes]


def write_mcap(run: Run, path: Path) -> None:
    """Write `run` to the MCAP file at `path`, complete or not at all. The same run always makes the same bytes.

    A file at `path` is replaced; its folder must exist. Topics: `/raw/<channel>` has blocks of 1024 float32 samples.
    `/clean/<channel>` has the same without noise, for a run whose clean channels are kept. `/preview/<quantity>` has
    minimum and maximum at about 1 kHz. Events are on `/contact`, `/once_per_rev`, `/blade_tip_timing/<probe>` and
    `/labels/motion`. A run with a motion track has `/motion/frames`, `/motion/casing_modes` and `/tf`. Times are
    integer ns from the first sample; an event that began before it has time 0. Scenario and labels are metadata records
    (`rubgen.scenario`, `rubgen.labels`; each value JSON) and attachments. Raises ValueError for a run without a
    recording, OSError where the file cannot be written.
    """
    if run.recording is None or run.labels is None:
        raise ValueError(f"{run.scenario.run_id} has status {run.response.status.code}: there is nothing to record")
    recording, labels = run.recording, run.labels
    write_durably(path, lambda part: _write_file(part, run, recording, labels))


def nanoseconds(seconds: float) -> int:
    """Round a time in s to whole ns."""
    return round(seconds * 1e9)


def _write_file(path: Path, run: Run, recording: Recording, labels: Labels) -> None:
    with path.open("wb") as stream:
        writer = new_writer(stream)
        write_records(writer, "scenario", scenario_dict(run.scenario))
        write_records(writer, "labels", labels_to_json(labels))
        _write_messages(writer, run, recording, labels)
        writer.finish()  # type: ignore[no-untyped-call]  # the mcap package annotates no return type


def new_writer(stream: IO[bytes]) -> Writer:
    """Begin an MCAP file of rubgen on `stream`, and return its writer."""
    writer = Writer(stream, chunk_size=CHUNK_BYTES, enable_data_crcs=True)
    writer.start(profile="", library=LIBRARY)
    return writer


def write_records(writer: Writer, name: str, values: dict[str, object]) -> None:
    """Write a document of a run, called `name`, as a metadata record and as a JSON attachment."""
    writer.add_metadata(f"rubgen.{name}", {key: json.dumps(value) for key, value in values.items()})
    content = json.dumps(values, indent=2).encode()
    writer.add_attachment(0, 0, f"{name}.json", "application/json", content)


def _write_messages(writer: Writer, run: Run, recording: Recording, labels: Labels) -> None:
    """Write every channel's messages in order of time; at equal times in the order of the channels."""
    schemas = {
        name: writer.register_schema(f"{PACKAGE}.{name}", "protobuf", file_descriptor_set()) for name in MESSAGES
    }
    multi_array = writer.register_schema(SCHEMA_NAME, "ros2msg", SCHEMA)
    merged: list[tuple[int, int, int, bytes]] = []

    def add(topic: str, schema: int, messages: Iterator[Stamped], metadata: dict[str, str] | None = None) -> None:
        encoding = "cdr" if schema == multi_array else "protobuf"
        channel = writer.register_channel(topic, encoding, schema, metadata or {})
        merged.extend((time, channel, sequence, data) for sequence, (time, data) in enumerate(messages))

    for name, channel in recording.channels.items():
        metadata = _describe(channel)
        add(f"/raw/{name}", schemas["SampleBlock"], _blocks(channel.values, recording.sample_rate_hz), metadata)
        if channel.clean is not None:
            add(f"/clean/{name}", schemas["SampleBlock"], _blocks(channel.clean, recording.sample_rate_hz), metadata)
    for quantity, group in recording.by_quantity().items():
        shown = preview(group, recording.sample_rate_hz)
        metadata = {"unit": group[0].unit, "names": ", ".join(shown.names)}
        add(f"/preview/{quantity}", multi_array, _arrays(shown, recording.sample_rate_hz), metadata)
    add("/contact", schemas["Contact"], _contacts(run, recording))
    add("/once_per_rev", schemas["OncePerRev"], _pulses(recording))
    for name, seen in recording.tip_timing.items():
        add(f"{TIMING}{name}", schemas["BladePassage"], _passages(seen), _describe_probe(run, name))
    add("/labels/motion", schemas["MotionLabel"], _motions(labels, recording))
    frames = motion_frames(run.response, recording)
    if frames is not None:
        add("/motion/frames", schemas["MotionFrame"], _frames(frames))
        add("/motion/casing_modes", schemas["CasingModes"], _casing_modes(frames))
        add("/tf", writer.register_schema(TRANSFORM, "protobuf", transform_descriptor_set()), _transforms(frames))
    for time, channel_id, sequence, data in sorted(merged, key=itemgetter(0, 1, 2)):
        writer.add_message(channel_id, time, data, publish_time=time, sequence=sequence)


def _describe(channel: Channel) -> dict[str, str]:
    """Return the metadata of a channel. Samples are already in `unit`, so their sensitivity is 1."""
    texts = {key: str(getattr(channel, key)) for key in TEXTS}
    return texts | {key: repr(float(getattr(channel, key))) for key in NUMBERS} | {"sensitivity": "1.0"}


def _blocks(values: Float32Array, sample_rate_hz: float) -> Iterator[Stamped]:
    for first in range(0, values.size, BLOCK_SAMPLES):
        time = nanoseconds(first / sample_rate_hz)
        yield time, sample_block(values[first : first + BLOCK_SAMPLES], sample_rate_hz, first, time)


def _arrays(shown: Preview, sample_rate_hz: float) -> Iterator[Stamped]:
    times = [nanoseconds(first / sample_rate_hz) for first in shown.first.tolist()]
    return zip(times, multi_arrays(shown.names, shown.values), strict=True)


def _messages(name: str, rows: Iterable[tuple[float, dict[str, Any]]]) -> Iterator[Stamped]:
    """Yield messages rubgen.v1.`name` with these fields, each at its time in s, or at 0 where that is negative."""
    message = message_class(name)
    for seconds, fields in rows:
        time = max(0, nanoseconds(seconds))
        yield time, message(timestamp=timestamp(time), **fields).SerializeToString(deterministic=True)


def _contacts(run: Run, recording: Recording) -> Iterator[Stamped]:
    touches = contact_intervals(run.response, recording)
    columns = {name: getattr(touches, field).tolist() for name, field in CONTACT_FIELDS.items()}
    rows = [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]
    return _messages("Contact", ((row["start_s"], row) for row in rows))


def _pulses(recording: Recording) -> Iterator[Stamped]:
    times = recording.once_per_rev.tolist()
    return _messages("OncePerRev", ((time, {"time_s": time, "turn": turn}) for turn, time in enumerate(times)))


def _describe_probe(run: Run, name: str) -> dict[str, str]:
    """Return the metadata of a timing probe: its place and its errors."""
    (probe,) = [each for each in run.scenario.sensing.set.sensors if each.name == name]
    values = {key: value for key, value in vars(probe).items() if key.endswith(("_deg", "_m", "_s", "_hz"))}
    return {"unit": "s", "quantity": "arrival time", **{key: repr(float(value)) for key, value in values.items()}}


def _passages(seen: TipTimes) -> Iterator[Stamped]:
    columns = zip(seen.time.tolist(), seen.blade.tolist(), seen.true_displacement.tolist(), strict=True)
    rows = ((t, {"time_s": t, "blade": blade, "true_displacement_m": true}) for t, blade, true in columns)
    return _messages("BladePassage", rows)


def _motions(labels: Labels, recording: Recording) -> Iterator[Stamped]:
    """Yield the class from the first sample on, and at a changing speed each later class within the recording."""
    classes = motion_classes(labels, recording.start_seconds, recording.samples / recording.sample_rate_hz)
    period = labels.period or 0 if labels.history is None else 0
    return _messages("MotionLabel", ((time, {**names, "period": period}) for time, names in classes))


def _frames(frames: MotionFrames) -> Iterator[Stamped]:
    for row, time_s in enumerate(frames.time.tolist()):
        fields = {
            "time_s": time_s,
            "angle_rad": frames.angle[row],
            "centre_m": frames.centre[row].tolist(),
            "tips_m": frames.tips[row].ravel().tolist(),
            "casing": frames.casing[row].tolist(),
            "dense": int(frames.dense[row]),
        }
        yield from _messages("MotionFrame", [(time_s, fields)])


def _casing_modes(frames: MotionFrames) -> Iterator[Stamped]:
    nodes, _, modes = frames.casing_modes.shape
    values = frames.casing_modes.ravel().tolist()
    return _messages("CasingModes", [(0.0, {"nodes": nodes, "modes": modes, "values": values})])


def _transforms(frames: MotionFrames) -> Iterator[Stamped]:
    """Yield the position of the turning blisk in the inertial frame, for every frame."""
    for row, time_s in enumerate(frames.time.tolist()):
        time = nanoseconds(time_s)
        yield time, transform(time, float(frames.angle[row]), frames.centre[row].tolist())
