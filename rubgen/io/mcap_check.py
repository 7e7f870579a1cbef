"""What is wrong with an MCAP file, in sentences."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from google.protobuf.message import DecodeError

from rubgen.io.mcap_messages import read_sample_block
from rubgen.io.mcap_read import UNREADABLE, McapContent, read_content
from rubgen.sensors.channel import quantity_key

TOPICS = ("/contact", "/once_per_rev", "/labels/motion")
CHANNEL_KEYS = ("unit", "quantity", "axis", "location", "range_min", "range_max", "resolution", "sensitivity")


def check_mcap(path: Path) -> list[str]:
    """Problems of the file at `path`, none for a good one.

    Checked: CRCs of chunks, data and summary; scenario and labels present and equal in metadata and attachments;
    channels described; blocks without gap, of one sample rate, at the times that their indices imply, of the length
    that the scenario asks; a preview for every quantity; messages in order of time.
    """
    try:
        content = read_content(path)
        return [*_document_problems(content), *_topic_problems(content), *_sample_problems(content)]
    except OSError as error:
        return [f"cannot be read ({error.strerror})"]
    except (*UNREADABLE, DecodeError) as error:
        return [f"damaged ({type(error).__name__}: {error})"]


def _document_problems(content: McapContent) -> Iterator[str]:
    for name in ("scenario", "labels"):
        record, attachment = content.metadata.get(f"rubgen.{name}"), content.attachments.get(f"{name}.json")
        if record is None or attachment is None:
            yield f"metadata rubgen.{name} or attachment {name}.json is missing"
        elif {key: json.loads(value) for key, value in record.items()} != json.loads(attachment):
            yield f"metadata rubgen.{name} and attachment {name}.json differ"


def _topic_problems(content: McapContent) -> Iterator[str]:
    for topic in TOPICS:
        if topic not in content.channels:
            yield f"topic {topic} is missing"
    for topic, channel in content.channels.items():
        missing = [key for key in CHANNEL_KEYS if key not in channel.metadata] if _is_signal(topic) else []
        if missing:
            yield f"{topic}: metadata lacks {', '.join(missing)}"
        elif topic.startswith("/raw/"):
            preview = f"/preview/{quantity_key(channel.metadata['quantity'])}"  # or this and a unit
            if not any(messages for name, messages in content.messages.items() if name.startswith(preview)):
                yield f"{topic}: {preview} is missing"
    for topic, messages in content.messages.items():
        times = [message.log_time for message in messages]
        if times != sorted(times):
            yield f"{topic}: messages are not in order of time"


def _sample_problems(content: McapContent) -> Iterator[str]:
    scenario = json.loads(content.attachments.get("scenario.json", b"{}"))
    asked = scenario.get("sensing", {}).get("sample_rate_hz", 0.0) * scenario.get("signal_seconds", 0.0)
    if not any(topic.startswith("/raw/") for topic in content.channels):
        yield "no channel under /raw"
    for topic in filter(_is_signal, content.channels):
        length = 0
        for message in content.messages.get(topic, []):
            time, rate, first, values = read_sample_block(message.data)
            if first != length or time != round(first / rate * 1e9) or time != message.log_time:
                yield f"{topic}: the block at sample {first} does not follow sample {length - 1} in index and time"
            if rate != scenario["sensing"]["sample_rate_hz"]:
                yield f"{topic}: sample rate {rate} is not the scenario's"
            length = first + values.size
        if abs(length - asked) > 1:
            yield f"{topic}: {length} samples, the scenario asks {asked:g}"


def _is_signal(topic: str) -> bool:
    return topic.startswith(("/raw/", "/clean/"))
