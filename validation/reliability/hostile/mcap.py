"""MCAP files by the real writer, with content that no run of rubgen has; or with records edited afterwards."""

from __future__ import annotations

import io
import json
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from google.protobuf.message import DecodeError
from mcap.records import Attachment, Channel, Message, Metadata, Schema
from mcap.stream_reader import StreamReader
from mcap.writer import CompressionType, Writer

from rubgen.io.mcap.messages import message_class
from validation.reliability.hostile.documents import json_bytes, mutated

FLOATS = (float("nan"), float("inf"), -1.0, 0.0, 1e300, 1e-300, 2.0**53)
INTEGERS = (0, 1, 2**31 - 1, 2**32 - 1, 2**63 - 1)
TIMES = (0, 1, 10**9, 2**63, 2**64 - 1)


@dataclass
class Content:
    """The records of a file."""

    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    messages: list[Message] = field(default_factory=list)
    metadata: list[Metadata] = field(default_factory=list)
    attachments: list[Attachment] = field(default_factory=list)


def hostile_mcap(path: Path, generator: np.random.Generator) -> bytes:
    """One file more, made of the good one at `path`."""
    good = _content(path)
    content = Content(
        dict(good.schemas), dict(good.channels), list(good.messages), list(good.metadata), list(good.attachments)
    )
    for _ in range(generator.integers(1, 3)):
        _CHANGES[generator.integers(len(_CHANGES))](content, generator)
    data = _written(content, generator)
    return _edited(data, generator) if generator.random() < 0.25 else data


@cache
def _content(path: Path) -> Content:
    content = Content()
    with path.open("rb") as stream:
        for record in StreamReader(stream).records:
            if isinstance(record, Schema):
                content.schemas[record.id] = record
            elif isinstance(record, Channel):
                content.channels[record.id] = record
            elif isinstance(record, Message):
                content.messages.append(record)
            elif isinstance(record, Metadata):
                content.metadata.append(record)
            elif isinstance(record, Attachment):
                content.attachments.append(record)
    return content


def _written(content: Content, generator: np.random.Generator) -> bytes:
    stream = io.BytesIO()
    packing = CompressionType.ZSTD if generator.random() < 0.8 else CompressionType.NONE
    writer = Writer(stream, compression=packing, enable_data_crcs=True)
    writer.start(library=str(generator.choice(["rubgen", "", "other"])))
    for data in content.metadata:
        writer.add_metadata(data.name, data.metadata)
    for each in content.attachments:
        writer.add_attachment(each.create_time, each.log_time, each.name, each.media_type, each.data)
    schemas = {old: writer.register_schema(s.name, s.encoding, s.data) for old, s in content.schemas.items()}
    channels = {
        old: writer.register_channel(c.topic, c.message_encoding, schemas.get(c.schema_id, 0), c.metadata)
        for old, c in content.channels.items()
    }
    for message in content.messages:
        if message.channel_id in channels:
            writer.add_message(
                channels[message.channel_id], message.log_time, message.data, message.publish_time, message.sequence
            )
    writer.finish()  # type: ignore[no-untyped-call]
    return stream.getvalue()


def _edited(data: bytes, generator: np.random.Generator) -> bytes:
    """A number in the framing that says something else."""
    place = int(generator.integers(8, len(data) - 8))
    place = [place, min(place, 2000), max(8, len(data) - 8 - place % 2000)][generator.integers(3)]
    number = int(generator.choice([0, 1, 255, 2**31, 2**40, 2**63]))
    return data[:place] + number.to_bytes(8, "little") + data[place + 8 :]


def _attachment(content: Content, generator: np.random.Generator) -> None:
    """Scenario or labels, wrong in a value, in both places or in one."""
    place = int(generator.integers(len(content.attachments)))
    old = content.attachments[place]
    try:
        document = mutated(json.loads(old.data), generator)
    except ValueError:
        return  # an integer of an earlier change is too long to be read
    content.attachments[place] = replace(old, data=json_bytes(document))
    if generator.random() < 0.7 and isinstance(document, dict):
        name = f"rubgen.{old.name.removesuffix('.json')}"
        values = {str(key): json_bytes(value).decode() for key, value in document.items()}
        content.metadata = [replace(each, metadata=values) if each.name == name else each for each in content.metadata]


def _field(content: Content, generator: np.random.Generator) -> None:
    """A field of one message, or of all of a topic, by its own type."""
    channel_id, chosen = _some_messages(content, generator)
    schema = content.schemas.get(content.channels[channel_id].schema_id)
    if schema is None or not schema.name.startswith("rubgen.v1."):
        return
    kind = message_class(schema.name.removeprefix("rubgen.v1."))
    seed = int(generator.integers(2**32))
    for place in chosen:
        try:
            message = kind.FromString(content.messages[place].data)
        except DecodeError:
            continue  # an earlier change left bytes that are no message
        _set_field(message, np.random.default_rng(seed))
        content.messages[place] = replace(content.messages[place], data=message.SerializeToString())


def _set_field(message: Any, generator: np.random.Generator) -> None:
    fields = message.DESCRIPTOR.fields
    chosen = fields[generator.integers(len(fields))]
    if chosen.type == chosen.TYPE_MESSAGE or generator.random() < 0.2:
        message.ClearField(chosen.name)
        return
    value: Any = str(generator.choice(["", "x", "chaotic", "é"]))
    if chosen.cpp_type in (chosen.CPPTYPE_DOUBLE, chosen.CPPTYPE_FLOAT):
        value = float(generator.choice(FLOATS))
    elif chosen.cpp_type != chosen.CPPTYPE_STRING:
        value = int(generator.choice(INTEGERS)) if "64" in _type_name(chosen) else int(generator.choice(INTEGERS[:3]))
    if _repeated(chosen):
        values = getattr(message, chosen.name)
        values.extend([value] * int(generator.choice([1, 7, 1000])))
    else:
        setattr(message, chosen.name, value)


def _type_name(chosen: Any) -> str:
    return {chosen.CPPTYPE_INT64: "int64", chosen.CPPTYPE_UINT64: "uint64"}.get(chosen.cpp_type, "int32")


def _repeated(chosen: Any) -> bool:
    return bool(chosen.is_repeated) if hasattr(chosen, "is_repeated") else chosen.label == chosen.LABEL_REPEATED


def _bytes(content: Content, generator: np.random.Generator) -> None:
    """Data of a message: cut, empty, of another topic, or noise."""
    _, chosen = _some_messages(content, generator)
    other = content.messages[generator.integers(len(content.messages))].data
    for place in chosen:
        old = content.messages[place].data
        new = [old[: len(old) // 2], b"", other, generator.bytes(40), old + old][generator.integers(5)]
        content.messages[place] = replace(content.messages[place], data=new)


def _time(content: Content, generator: np.random.Generator) -> None:
    _, chosen = _some_messages(content, generator)
    for place in chosen:
        time = TIMES[generator.integers(len(TIMES))]
        content.messages[place] = replace(content.messages[place], log_time=time, publish_time=time)


def _channel(content: Content, generator: np.random.Generator) -> None:
    """Its topic, schema, encoding or metadata."""
    number = int(generator.choice(list(content.channels)))
    old = content.channels[number]
    topics = [each.topic for each in content.channels.values()]
    wrong: dict[str, Any] = {
        "topic": str(
            generator.choice([*topics, "", "/raw/", "/raw/../x", "/blade_tip_timing/x", "/raw/é", "/motion/frames"])
        ),
        "schema_id": int(generator.choice([0, *content.schemas])),
        "message_encoding": str(generator.choice(["", "json", "protobuf", "cdr"])),
        "metadata": {str(key): _text(value) for key, value in _table(mutated(old.metadata, generator)).items()},
    }
    key = str(generator.choice(list(wrong)))
    content.channels[number] = replace(old, **{key: wrong[key]})


def _table(document: Any) -> dict[Any, Any]:
    return document if isinstance(document, dict) else {}


def _text(value: Any) -> str:
    return value.encode(errors="replace").decode() if isinstance(value, str) else json_bytes(value).decode()


def _drop(content: Content, generator: np.random.Generator) -> None:
    """No topic, messages, attachment or metadata record; or messages twice, or in another order."""
    number, chosen = _some_messages(content, generator)
    case = generator.integers(6)
    if case == 0:
        del content.channels[number]
    elif case == 1:
        content.messages = [m for place, m in enumerate(content.messages) if place not in set(chosen)]
    elif case == 2:
        del content.attachments[generator.integers(len(content.attachments))]
    elif case == 3:
        del content.metadata[generator.integers(len(content.metadata))]
    elif case == 4:
        content.messages += [content.messages[place] for place in chosen]
    else:
        content.messages = [content.messages[place] for place in generator.permutation(len(content.messages))]


def _some_messages(content: Content, generator: np.random.Generator) -> tuple[int, list[int]]:
    """A topic that has messages, and the places of all of them or of one."""
    number = content.messages[generator.integers(len(content.messages))].channel_id
    if generator.random() < 0.7:
        number = int(
            generator.choice(
                sorted({message.channel_id for message in content.messages} & set(content.channels)) or [number]
            )
        )
    places = [place for place, message in enumerate(content.messages) if message.channel_id == number]
    return number, places if generator.random() < 0.5 else [places[generator.integers(len(places))]]


_CHANGES = (_attachment, _attachment, _attachment, _field, _field, _field, _bytes, _time, _channel, _drop)
