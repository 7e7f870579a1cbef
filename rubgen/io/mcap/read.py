"""Reading of runs from MCAP files: whole files with every checksum checked, and the rest of damaged files."""

from collections.abc import Collection
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.errors import UserError
from rubgen.io.mcap.content import (
    TIMING,
    McapContent,
    check_facts,
    check_kind,
    check_order,
    checked_labels,
    checked_scenario,
    decoded,
    event_columns,
    read_content,
)
from rubgen.io.mcap.messages import read_sample_block
from rubgen.io.mcap.records import DamageError, damage_found
from rubgen.labels.labels import Motion
from rubgen.labels.to_json import MOTION_LABELS
from rubgen.measurement.channel import Float32Array
from rubgen.measurement.motion import MotionFrames
from rubgen.scenario import Scenario

MOST_NAMED = 3
OTHER_FORMATS = (".parquet", ".rrd")
"""Endings of files of a run that cannot be read back as a run."""
FRAMES, MODES = "/motion/frames", "/motion/casing_modes"


def read_frames(content: McapContent, scenario: Scenario) -> MotionFrames | None:
    """Decode the frames of motion: displacements of disk, tips and casing at single moments. None if the file has none.

    Raises DamageError where the sizes of the frames contradict each other or the machine, a value is not finite, times
    descend, or a time is outside of the recording.
    """
    found, shapes = decoded(content, FRAMES), decoded(content, MODES)
    if not found or not shapes:
        return None
    check_order(content, FRAMES)
    blades, modes = scenario.machine.blades.count, shapes[0]
    sizes = {(len(row.centre_m), len(row.tips_m), len(row.casing)) for row in found}
    if sizes != {(2, 3 * blades, modes.modes)}:
        raise DamageError(f"{FRAMES}: sizes are not those of {blades} blades and {modes.modes} modes of the casing")
    if len(modes.values) != 2 * modes.nodes * modes.modes or not modes.values:
        raise DamageError(f"{MODES}: {len(modes.values)} values for {modes.nodes} nodes and {modes.modes} modes")
    frames = MotionFrames(
        time=np.array([row.time_s for row in found]),
        angle=np.array([row.angle_rad for row in found]),
        centre=np.array([row.centre_m for row in found], dtype=np.float64),
        tips=np.array([row.tips_m for row in found], dtype=np.float64).reshape(len(found), -1, 3),
        casing=np.array([row.casing for row in found], dtype=np.float64),
        dense=np.array([row.dense for row in found], dtype=np.int64),
        casing_modes=np.array(modes.values, dtype=np.float64).reshape(modes.nodes, 2, modes.modes),
    )
    _check_values(frames, scenario.signal_seconds)
    return frames


def _check_values(frames: MotionFrames, seconds: float) -> None:
    for name in MotionFrames.__dataclass_fields__:
        if not np.isfinite(getattr(frames, name)).all():
            raise DamageError(f"{FRAMES}: {name} is not finite")
    time = frames.time
    if (np.diff(time) < 0).any() or time[0] < 0 or time[-1] > seconds:
        raise DamageError(f"{FRAMES}: times do not ascend within the recording of {seconds:g} s")
    if (frames.dense > 1).any():
        raise DamageError(f"{FRAMES}: dense is neither 0 nor 1")


@dataclass(frozen=True, kw_only=True)
class McapRun:
    """One run from an MCAP file."""

    scenario: dict[str, Any]
    """The scenario as in `scenario.json`."""
    labels: dict[str, Any]
    """The labels by their public names."""
    sample_rate_hz: float
    """Sample rate of all channels."""
    signals: dict[str, Float32Array]
    """Samples (n,) float32 of each channel by its name, in its unit."""
    clean: dict[str, Float32Array]
    """The same of clean channels, by the names of `signals`."""
    channels: dict[str, dict[str, str]]
    """Unit, quantity, axis, location, range and so on of each channel."""
    contacts: dict[str, FloatArray]
    """Fields of rubgen.v1.Contact, each (n_events,)."""
    once_per_rev: FloatArray
    """Times of the pulses (n_pulses,), s."""
    tip_timing: dict[str, dict[str, FloatArray]]
    """Fields of rubgen.v1.BladePassage by the probe's name."""
    frames: MotionFrames | None
    """The motion; None where the file has none."""
    motion_classes: dict[str, list[tuple[float, str]]]
    """For each of the labels `motion`, `motion_blisk`, `motion_casing`, its classes with the times in s from which they
    are valid."""


def read_mcap(path: Path, *, channels: Collection[str] | None = None) -> McapRun:
    """Read the run in the MCAP file at `path`. CRCs of chunks, data and summary, and the content, are checked.

    `channels` are names of channels (`<name>_clean` for the channel without noise): only these channels, the pulses,
    scenario and labels are decoded. A name without a channel is ignored. None decodes everything. Raises UserError, one
    line, where the file does not exist, is damaged, or has no run of rubgen.
    """
    try:
        return run_of(read_content(path), channels=channels)
    except OSError as error:
        raise UserError(f"{path}: cannot be read ({error.strerror}); give an existing .mcap file") from None
    except DamageError as damage:
        if path.suffix in OTHER_FORMATS:
            raise UserError(
                f"{path}: a run is read from its .mcap file alone; write one with rubgen simulate --out run.mcap"
            ) from None
        raise UserError(f"{path}: damaged or no run of rubgen ({damage}); generate it again") from None


def run_of(content: McapContent, *, gaps: bool = False, channels: Collection[str] | None = None) -> McapRun:
    """Make the run from the records of its file. Raises DamageError where they are not a run of rubgen.

    - gaps: True sets missing samples to NaN; False raises DamageError for a missing block. Without any sample of a
      channel it is raised in both cases.
    - channels: names of the channels to decode, with pulses, scenario and labels alone; None decodes everything.
    """
    plain, scenario = checked_scenario(content)
    if not content.topics("/raw/"):
        raise DamageError("no channel under /raw")
    if channels is not None:
        content = _only(content, channels)
    for topic in (*content.topics("/raw/"), *content.topics("/clean/")):
        check_facts(content.channels[topic])
    return McapRun(
        scenario=plain,
        labels=checked_labels(content),
        sample_rate_hz=scenario.sensing.sample_rate_hz,
        signals=_signals(content, "/raw/", scenario, gaps=gaps),
        clean=_signals(content, "/clean/", scenario, gaps=gaps),
        channels={topic.removeprefix("/raw/"): content.channels[topic].metadata for topic in content.topics("/raw/")},
        contacts=event_columns(content, "/contact", scenario),
        once_per_rev=event_columns(content, "/once_per_rev", scenario)["time_s"],
        tip_timing={
            topic.removeprefix(TIMING): event_columns(content, topic, scenario) for topic in content.topics(TIMING)
        },
        frames=read_frames(content, scenario),
        motion_classes=_motion_classes(content),
    )


def _only(content: McapContent, channels: Collection[str]) -> McapContent:
    """Return the content with only the messages of these channels and of the pulses."""
    clean = {f"/clean/{name.removesuffix('_clean')}" for name in channels if name.endswith("_clean")}
    topics = {"/once_per_rev", *(f"/raw/{name}" for name in channels), *clean}
    return replace(
        content,
        channels={topic: channel for topic, channel in content.channels.items() if topic in topics},
        messages={topic: messages for topic, messages in content.messages.items() if topic in topics},
    )


def _signals(content: McapContent, prefix: str, scenario: Scenario, *, gaps: bool) -> dict[str, Float32Array]:
    """Return the samples of every channel under `prefix`, all of one length."""
    topics = content.topics(prefix)
    length = round(scenario.signal_seconds * scenario.sensing.sample_rate_hz) if gaps else None
    signals = {
        topic.removeprefix(prefix): _samples(content, topic, scenario.sensing.sample_rate_hz, length)
        for topic in topics
    }
    if len({values.size for values in signals.values()}) > 1:
        raise DamageError(f"channels under {prefix} differ in length")
    return signals


def _samples(content: McapContent, topic: str, rate: float, length: int | None) -> Float32Array:
    """Join the blocks of a channel. With a `length` each block is put at its index, with NaN between."""
    check_kind(content, topic, "SampleBlock")
    check_order(content, topic)
    parts = [np.empty(0, np.float32)]
    end = 0
    for message in content.messages.get(topic, []):
        with damage_found(f"{topic}: a block"):
            _, found, first, values = read_sample_block(message.data)
        if found != rate:
            raise DamageError(f"{topic}: sample rate {found:g} is not the scenario's {rate:g}")
        if first < end or (length is None and first > end):
            raise DamageError(f"{topic}: the block at sample {first} does not follow sample {end - 1}")
        if length is not None and first + values.size > length:
            raise DamageError(f"{topic}: a block ends at sample {first + values.size}, the scenario asks {length}")
        if not np.isfinite(values).all():
            raise DamageError(f"{topic}: samples are not finite")
        parts += [np.full(first - end, np.nan, np.float32), values]
        end = first + values.size
    if length is not None:
        parts.append(np.full(length - end, np.nan, np.float32))
    if not end:
        raise DamageError(f"{topic}: no sample can be read")
    return np.concatenate(parts)


def _motion_classes(content: McapContent) -> dict[str, list[tuple[float, str]]]:
    found = decoded(content, "/labels/motion")
    check_order(content, "/labels/motion")
    known = {motion.value for motion in Motion}
    for row in found:
        unknown = {getattr(row, name) for name in MOTION_LABELS} - known
        if unknown:
            raise DamageError(f"/labels/motion: no class of motion is called {min(unknown)!r:.40}")
    times = [1e-9 * message.log_time for message in content.messages.get("/labels/motion", [])]
    return {
        name: [(time, getattr(row, name)) for time, row in zip(times, found, strict=True)] for name in MOTION_LABELS
    }


def salvage_mcap(path: Path) -> tuple[McapRun, list[str]]:
    """Read the undamaged parts of the run in the MCAP file at `path`. Return the run and its losses, one sentence each.

    The list is empty for a good file. Chunks with a wrong CRC are left out, and everything after the position from
    which the records cannot be followed. Lost samples are NaN. Raises UserError where scenario or labels are lost, the
    rest contradicts itself, or the file was not written by rubgen.
    """
    try:
        return read_mcap(path), []
    except UserError as error:
        whole = UserError(str(error))  # without the frames that still hold what was read
    lost: list[str] = []
    try:
        content = read_content(path, lost)
        run = run_of(content, gaps=bool(lost))
    except (DamageError, UserError, OSError):
        raise whole from None
    return run, _shortened(lost) or ["nothing that is shown"]


def _shortened(lost: list[str]) -> list[str]:
    more = len(lost) - MOST_NAMED
    return lost[:MOST_NAMED] + ([f"and {more} more pieces"] if more > 0 else [])
