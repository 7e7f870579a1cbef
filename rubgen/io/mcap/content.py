"""The content of an MCAP file by name, and the checks that turn it into typed values of a run."""

import math
from collections import defaultdict
from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from mcap.records import Attachment, Channel, Message, Metadata, Schema
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from rubgen.arrays import FloatArray
from rubgen.io.files import read_json
from rubgen.io.mcap.foxglove import SCHEMA_NAME, TRANSFORM, read_multi_array, read_transform
from rubgen.io.mcap.messages import PACKAGE, message_class
from rubgen.io.mcap.records import DamageError, damage_found, read_records
from rubgen.labels.labels import Motion
from rubgen.scenario import Scenario

TIMING = "/blade_tip_timing/"
"""Beginning of the topics of timing probes."""
MESSAGE_OF_TOPIC = {
    "/raw/": "SampleBlock",
    "/clean/": "SampleBlock",
    TIMING: "BladePassage",
    "/contact": "Contact",
    "/once_per_rev": "OncePerRev",
    "/labels/motion": "MotionLabel",
    "/motion/frames": "MotionFrame",
    "/motion/casing_modes": "CasingModes",
}
"""Message of each topic. A name that ends with a slash stands for all topics that begin with it."""
MOST_MESSAGES = 500_000
"""Number of messages that is allowed for any file; a larger file may have one for every byte."""
SLACK_S = 1.0
"""Largest distance of an event from the recording."""
MOST_SAMPLES = 2**28
"""Largest number of samples of all channels of a file: a gigabyte."""

Whole = Annotated[int, Field(ge=-(2**63), lt=2**63, strict=True)]
Number = Annotated[float, Field(allow_inf_nan=False, strict=True)]
Single = bool | Whole | Number | None
LabelName = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,99}$")]
LabelValue = Single | Annotated[str, Field(max_length=200)] | list[Single]


@dataclass(frozen=True, kw_only=True)
class McapContent:
    """All records of a file by name: messages by topic in file order, metadata, attachments, schema names by id."""

    channels: dict[str, Channel] = field(default_factory=dict)
    messages: dict[str, list[Message]] = field(default_factory=lambda: defaultdict(list))
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    attachments: dict[str, bytes] = field(default_factory=dict)
    schemas: dict[int, str] = field(default_factory=dict)

    def topics(self, prefix: str) -> list[str]:
        """Return the topics whose names begin with `prefix`, in file order."""
        return [topic for topic in self.channels if topic.startswith(prefix)]

    def document(self, name: str) -> dict[str, Any]:
        """Parse the attachment `name` as a JSON object. Raises DamageError where it is missing or is no JSON object."""
        if name not in self.attachments:
            raise DamageError(f"attachment {name} is missing: this is no run of rubgen")
        with damage_found(f"attachment {name}"):
            values = read_json(self.attachments[name])
        if not isinstance(values, dict):
            raise DamageError(f"attachment {name} is no table of names and values")
        return values


def read_content(path: Path, lost: list[str] | None = None) -> McapContent:
    """Read every record of the file at `path`.

    If a list `lost` is given, damaged parts and messages without a described channel are left out, and a text about
    each damaged part is appended to the list. Without `lost` DamageError is raised for them. It is always raised for a
    file that does not begin like MCAP, for too many messages, and where two channels, metadata records or attachments
    share a name. Raises UserError or OSError where the file cannot be read at all.
    """
    content = McapContent()
    topics: dict[int, str] = {}
    messages: list[Message] = []
    most = max(MOST_MESSAGES, path.stat().st_size)
    for record in read_records(path, lost):
        if isinstance(record, Schema):
            content.schemas[record.id] = record.name
        elif isinstance(record, Channel):
            _add_channel(content, topics, record)
        elif isinstance(record, Message):
            messages.append(record)
            if len(messages) > most:
                raise DamageError(f"has more than {most:,} messages; that is no file of rubgen")
        elif isinstance(record, Metadata):
            _add("metadata", content.metadata, record.name, record.metadata)
        elif isinstance(record, Attachment):
            _add("attachment", content.attachments, record.name, record.data)
    for message in messages:  # a channel may be described only in the summary, where its first chunk is lost
        if message.channel_id in topics:
            content.messages[topics[message.channel_id]].append(message)
        elif lost is None:
            raise DamageError(f"has messages of a channel {message.channel_id} that is not described")
    return content


def _add_channel(content: McapContent, topics: dict[int, str], record: Channel) -> None:
    there = content.channels.get(record.topic)
    if topics.get(record.id, record.topic) != record.topic or there not in (None, record):
        raise DamageError(f"channel {record.topic!r:.80} or its number is described twice and differently")
    topics[record.id], content.channels[record.topic] = record.topic, record


def _add(kind: str, there: dict[str, Any], name: str, value: object) -> None:
    if name in there:
        raise DamageError(f"{kind} {name!r:.80} stands there twice")
    there[name] = value


def message_name(topic: str) -> str | None:
    """Return the name of the message that `topic` carries, such as "Contact". None for an unknown topic."""
    names = (
        name for key, name in MESSAGE_OF_TOPIC.items() if topic == key or (key.endswith("/") and topic.startswith(key))
    )
    return next(names, None)


def decoded(content: McapContent, topic: str) -> list[Any]:
    """Decode the messages of a topic. The list is empty where the topic is missing or unknown.

    Raises DamageError where the topic has messages of another type or the bytes cannot be decoded.
    """
    name = message_name(topic)
    if name is None or topic not in content.channels:
        return []
    check_kind(content, topic, name)
    kind = message_class(name)
    with damage_found(f"{topic}: a message"):
        return [kind.FromString(message.data) for message in content.messages.get(topic, [])]


def check_kind(content: McapContent, topic: str, name: str) -> None:
    """Check that the topic has messages of the type rubgen.v1.`name`. Raises DamageError where it does not."""
    _check_schema(content, content.channels[topic], f"{PACKAGE}.{name}", "protobuf")


def check_other(content: McapContent, topic: str) -> None:
    """Check a topic that is written for other programs: `/tf` and previews. Every message is decoded.

    Raises DamageError where messages are of another type or cannot be decoded, a preview has other names than its
    channel or values that are not finite, and for any other topic.
    """
    channel = content.channels[topic]
    if topic == "/tf":
        _check_schema(content, channel, TRANSFORM, "protobuf")
        with damage_found(f"{topic}: a message"):
            for message in content.messages.get(topic, []):
                read_transform(message.data)
    elif topic.startswith("/preview/"):
        _check_schema(content, channel, SCHEMA_NAME, "cdr")
        with damage_found(f"{topic}: a message"):
            found = [read_multi_array(message.data) for message in content.messages.get(topic, [])]
        named = all(", ".join(names) == channel.metadata.get("names") for names, _ in found)
        if not named or not np.isfinite(np.concatenate([np.zeros(0), *(values for _, values in found)])).all():
            raise DamageError(f"{topic}: a message has other names than the channel, or values that are not finite")
    else:
        raise DamageError(f"topic {topic!r:.80} is none of rubgen")


def _check_schema(content: McapContent, channel: Channel, name: str, encoding: str) -> None:
    found = content.schemas.get(channel.schema_id, name)
    if (found, channel.message_encoding) != (name, encoding):
        raise DamageError(
            f"{channel.topic} carries {found!r:.80} in {channel.message_encoding!r:.20}, not {name} in {encoding}"
        )


def event_columns(content: McapContent, topic: str, scenario: Scenario) -> dict[str, FloatArray]:
    """Decode the events of a topic, such as contacts, into one array (n_events,) for each field of their message.

    The field `timestamp` is left out. `scenario` has the number of blades and the length of the recording. Raises
    DamageError where a value is not finite, a blade does not exist, events are not in order, or an event ends more than
    SLACK_S before the recording or begins more than SLACK_S after it.
    """
    found = decoded(content, topic)
    names = [each.name for each in message_class(message_name(topic) or "").DESCRIPTOR.fields]
    values = {
        name: np.array([getattr(row, name) for row in found], dtype=np.float64) for name in names if name != "timestamp"
    }
    check_order(content, topic)
    for name, each in values.items():
        if not np.isfinite(each).all():
            raise DamageError(f"{topic}: {name} is not finite")
    blades = scenario.machine.blades.count
    if "blade" in values and (values["blade"] >= blades).any():
        raise DamageError(f"{topic}: there is no blade {values['blade'].max():.0f}; the machine has {blades}")
    start = values.get("start_s", values.get("time_s"))
    if start is not None:
        _check_times(topic, start, start + values.get("duration_s", 0.0), scenario.signal_seconds)
    return values


def _check_times(topic: str, start: FloatArray, end: FloatArray, seconds: float) -> None:
    if (end < start).any() or (end < -SLACK_S).any() or (start > seconds + SLACK_S).any() or (end - start > 1e6).any():
        raise DamageError(f"{topic}: an event lies outside the recording of {seconds:g} s, or ends before it begins")


def check_order(content: McapContent, topic: str) -> None:
    """Check that the times of a topic's messages never decrease. Raises DamageError where they do."""
    times = [message.log_time for message in content.messages.get(topic, [])]
    if any(later < earlier for earlier, later in pairwise(times)):
        raise DamageError(f"{topic}: messages are not in order of time")


class RequiredLabels(BaseModel):
    """The labels without which a replay cannot be shown, with their types."""

    model_config = ConfigDict(strict=False, extra="ignore")
    rub: Annotated[bool, Field(strict=True)]
    motion: Motion
    motion_blisk: Motion
    motion_casing: Motion


class ChannelFacts(BaseModel):
    """The metadata of a channel of samples, with its types. MCAP stores the values as text."""

    model_config = ConfigDict(extra="ignore")
    unit: str
    quantity: str
    axis: str
    location: str
    range_min: Annotated[float, Field(allow_inf_nan=False)]
    range_max: Annotated[float, Field(allow_inf_nan=False)]
    resolution: Annotated[float, Field(allow_inf_nan=False, ge=0)]
    noise_rms: Annotated[float, Field(allow_inf_nan=False, ge=0)] = 0.0


def checked_scenario(content: McapContent) -> tuple[dict[str, Any], Scenario]:
    """Return the scenario in the file, as plain values and as a `Scenario`.

    Raises DamageError where this version of rubgen cannot read it, or it has more samples than rubgen makes.
    """
    plain = content.document("scenario.json")
    scenario: Scenario = _validated(_adapter(Scenario), plain, "its scenario is of another rubgen")
    samples = scenario.signal_seconds * scenario.sensing.sample_rate_hz
    if not 0 < samples * max(len(content.topics("/raw/")) + len(content.topics("/clean/")), 1) <= MOST_SAMPLES:
        raise DamageError(f"its scenario asks {samples:.3g} samples a channel; that is no run of rubgen")
    return plain, scenario


def run_number(scenario: dict[str, Any]) -> int | None:
    """Return the number of the run in its set from a checked scenario; None where the scenario has no `index`."""
    index = scenario.get("index")
    return index + (scenario.get("merged") or {}).get("first", 0) if isinstance(index, int) else None


def checked_labels(content: McapContent) -> dict[str, Any]:
    """Return the labels by name, each a value or a list of values.

    Raises DamageError where a label of `RequiredLabels` is missing, or a name or value is not of a kind that rubgen
    writes.
    """
    labels = content.document("labels.json")
    _validated(_adapter(dict[LabelName, LabelValue]), labels, "labels.json is not what rubgen writes")
    _validated(_adapter(RequiredLabels), labels, "labels.json is not what rubgen writes")
    return labels


def check_facts(channel: Channel) -> None:
    """Check unit, position and range in the metadata of a channel.

    Raises DamageError where a value is missing or wrong.
    """
    facts: ChannelFacts = _validated(_adapter(ChannelFacts), channel.metadata, f"metadata of {channel.topic}")
    if not math.isfinite(facts.range_max - facts.range_min) or facts.range_max < facts.range_min:
        raise DamageError(f"metadata of {channel.topic}: the range is empty")


def _validated(adapter: TypeAdapter[Any], values: object, what: str) -> Any:
    try:
        return adapter.validate_python(values)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])[:100]
        raise DamageError(f"{what} ({where}: {' '.join(first['msg'].split())[:150]})") from None


@cache
def _adapter(kind: Any) -> TypeAdapter[Any]:
    return TypeAdapter(kind)
