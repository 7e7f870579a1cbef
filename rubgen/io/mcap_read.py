"""Runs back from MCAP files, with every checksum checked."""

from __future__ import annotations

import json
import struct
import zlib
from collections import defaultdict
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, McapRecord, Message, Metadata
from mcap.stream_reader import StreamReader
from zstandard import ZstdError

from rubgen.arrays import FloatArray
from rubgen.errors import UserError
from rubgen.io.mcap_messages import message_class, read_sample_block
from rubgen.sensors.channel import Float32Array
from rubgen.sensors.motion_frames import MotionFrames

UNREADABLE = (McapError, ZstdError, ValueError, EOFError, struct.error, KeyError, MemoryError)
"""What the mcap package raises for a file that is damaged or no MCAP (its CRC error is a ValueError)."""
TIMING = "/blade_tip_timing/"
"""Topics of timing probes begin so."""
_MAGIC_BYTES = 8
_FOOTER = struct.Struct("<BQQQI")  # opcode, length, summary start, summary offset start, CRC


@dataclass(frozen=True, kw_only=True)
class McapRun:
    """One run from an MCAP file.

    `signals` and `clean` map a channel's name to its samples (n,), float32, in the unit that `channels[name]` names
    beside quantity, axis, location and range. `contacts` maps a field of rubgen.v1.Contact to its values (n_events,);
    `once_per_rev` (n_pulses,) in s. `tip_timing` maps a timing probe's name to fields of rubgen.v1.BladePassage.
    `frames` is the motion, None where the file has none. `motion_classes` maps each of the labels `motion`,
    `motion_blisk`, `motion_casing` to its classes with the times in s from which on they hold.
    """

    scenario: dict[str, Any]
    labels: dict[str, Any]
    sample_rate_hz: float
    signals: dict[str, Float32Array]
    clean: dict[str, Float32Array]
    channels: dict[str, dict[str, str]]
    contacts: dict[str, FloatArray]
    once_per_rev: FloatArray
    tip_timing: dict[str, dict[str, FloatArray]]
    frames: MotionFrames | None
    motion_classes: dict[str, list[tuple[float, str]]]


@dataclass(frozen=True, kw_only=True)
class McapContent:
    """All records of a file by name: messages by topic in file order, metadata, attachments."""

    channels: dict[str, Channel]
    messages: dict[str, list[Message]]
    metadata: dict[str, dict[str, str]]
    attachments: dict[str, bytes]


def read_mcap(path: Path, *, channels: Collection[str] | None = None) -> McapRun:
    """The run in the file at `path`; chunk, data and summary CRCs are validated.

    With `channels` (`<name>_clean` for a clean one) these alone are decoded, and the pulses, of all that was recorded.
    Raises UserError, one line, when there is no such file, it is damaged, or no run of rubgen is in it.
    """
    try:
        content = read_content(path)
        return run_of(content if channels is None else _only(content, channels))
    except OSError as error:
        raise UserError(f"{path}: cannot be read ({error.strerror}); give an existing .mcap file") from None
    except UNREADABLE as error:
        reason = f"{type(error).__name__}: {error}".strip(": ")
        raise UserError(f"{path}: damaged or no run of rubgen ({reason}); generate it again") from None


def _only(content: McapContent, channels: Collection[str]) -> McapContent:
    """The content without the messages of all other channels and of what is no signal but a pulse."""
    clean = {f"/clean/{name.removesuffix('_clean')}" for name in channels if name.endswith("_clean")}
    topics = {"/once_per_rev", *(f"/raw/{name}" for name in channels), *clean}
    return replace(
        content,
        channels={topic: channel for topic, channel in content.channels.items() if topic in topics},
        messages={topic: messages for topic, messages in content.messages.items() if topic in topics},
    )


def read_content(path: Path) -> McapContent:
    """Every record of the file, CRCs validated; raises OSError or one of `UNREADABLE`."""
    content = McapContent(channels={}, messages=defaultdict(list), metadata={}, attachments={})
    topics: dict[int, str] = {}
    for record in _records(path):
        if isinstance(record, Channel):
            topics[record.id] = record.topic
            content.channels[record.topic] = record
        elif isinstance(record, Message):
            content.messages[topics[record.channel_id]].append(record)
        elif isinstance(record, Metadata):
            content.metadata[record.name] = record.metadata
        elif isinstance(record, Attachment):
            content.attachments[record.name] = record.data
    return content


def _records(path: Path) -> Iterator[McapRecord]:
    _validate_summary(path.read_bytes())
    with path.open("rb") as stream:
        yield from StreamReader(stream, validate_crcs=True).records


def _validate_summary(data: bytes) -> None:
    """Check the CRC of the summary section, which the mcap package leaves unchecked."""
    footer = len(data) - _MAGIC_BYTES - _FOOTER.size
    if footer < _MAGIC_BYTES:
        raise EOFError("too short for an MCAP file")
    opcode, _, summary_start, _, crc = _FOOTER.unpack_from(data, footer)
    if opcode != Opcode.FOOTER:
        raise EOFError("the file does not end with a footer")
    if zlib.crc32(data[summary_start : footer + _FOOTER.size - 4]) != crc:
        raise ValueError("crc validation failed in the summary")


def run_of(content: McapContent, *, gaps: bool = False) -> McapRun:
    """The run in these records; with `gaps` samples may be missing and are NaN, else they would follow one another.

    Raises one of `UNREADABLE` where the content is not that of a run.
    """
    rates = {rate for topic in content.messages if topic.startswith("/raw/") for rate in _rates(content, topic)}
    (sample_rate,) = rates or {float("nan")}
    scenario = json.loads(content.attachments["scenario.json"])
    length = round(scenario["signal_seconds"] * sample_rate) if gaps else 0
    return McapRun(
        scenario=scenario,
        labels=json.loads(content.attachments["labels.json"]),
        sample_rate_hz=sample_rate,
        signals=_signals(content, "/raw/", length),
        clean=_signals(content, "/clean/", length),
        channels={
            topic.removeprefix("/raw/"): channel.metadata
            for topic, channel in content.channels.items()
            if topic.startswith("/raw/")
        },
        contacts=_columns(content, "/contact", "Contact"),
        once_per_rev=_columns(content, "/once_per_rev", "OncePerRev")["time_s"],
        tip_timing={
            topic.removeprefix(TIMING): _columns(content, topic, "BladePassage")
            for topic in content.channels
            if topic.startswith(TIMING)
        },
        frames=_frames(content),
        motion_classes=_motion_classes(content),
    )


def _rates(content: McapContent, topic: str) -> set[float]:
    return {read_sample_block(message.data)[1] for message in content.messages[topic]}


def _signals(content: McapContent, prefix: str, length: int) -> dict[str, Float32Array]:
    """Samples of every channel under `prefix`, joined in the order of the blocks, or put into a length with gaps."""
    signals = {}
    for topic in (topic for topic in content.channels if topic.startswith(prefix)):
        blocks = [read_sample_block(message.data) for message in content.messages.get(topic, [])]
        joined = np.full(length, np.nan, np.float32)
        for _, _, first, values in blocks:
            joined[first : first + values.size] = values[: max(length - first, 0)]
        if not length:
            joined = np.concatenate([np.empty(0, np.float32), *(values for _, _, _, values in blocks)])
        signals[topic.removeprefix(prefix)] = joined
    return signals


def _columns(content: McapContent, topic: str, message_name: str) -> dict[str, FloatArray]:
    message = message_class(message_name)
    rows = [message.FromString(record.data) for record in content.messages.get(topic, [])]
    names = [field.name for field in message.DESCRIPTOR.fields if field.name != "timestamp"]
    return {name: np.array([getattr(row, name) for row in rows], dtype=np.float64) for name in names}


def _motion_classes(content: McapContent) -> dict[str, list[tuple[float, str]]]:
    label = message_class("MotionLabel")
    rows = [(1e-9 * row.log_time, label.FromString(row.data)) for row in content.messages.get("/labels/motion", [])]
    names = ("motion", "motion_blisk", "motion_casing")
    return {name: [(time, str(getattr(row, name))) for time, row in rows] for name in names}


def _frames(content: McapContent) -> MotionFrames | None:
    found, shapes = content.messages.get("/motion/frames"), content.messages.get("/motion/casing_modes")
    if not found or not shapes:
        return None
    rows = [message_class("MotionFrame").FromString(record.data) for record in found]
    modes = message_class("CasingModes").FromString(shapes[0].data)
    return MotionFrames(
        time=np.array([row.time_s for row in rows]),
        angle=np.array([row.angle_rad for row in rows]),
        centre=np.array([row.centre_m for row in rows], dtype=np.float64),
        tips=np.array([row.tips_m for row in rows], dtype=np.float64).reshape(len(rows), -1, 3),
        casing=np.array([row.casing for row in rows], dtype=np.float64),
        dense=np.array([row.dense for row in rows], dtype=np.int64),
        casing_modes=np.array(modes.values, dtype=np.float64).reshape(modes.nodes, 2, modes.modes),
    )
