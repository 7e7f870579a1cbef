"""Check an MCAP file of a run. Problems are sentences."""

from collections.abc import Callable, Iterator
from pathlib import Path

from rubgen.errors import UserError
from rubgen.io.files import read_json
from rubgen.io.mcap.content import (
    McapContent,
    check_order,
    check_other,
    checked_scenario,
    decoded,
    message_name,
    read_content,
    run_number,
)
from rubgen.io.mcap.messages import read_sample_block
from rubgen.io.mcap.read import run_of
from rubgen.io.mcap.records import DamageError, damage_found
from rubgen.measurement.channel import quantity_key
from rubgen.scenario import Scenario
from rubgen.scenario.run_id import run_id_of

TOPICS = ("/contact", "/once_per_rev", "/labels/motion")
CHANNEL_KEYS = ("unit", "quantity", "axis", "location", "range_min", "range_max", "resolution", "sensitivity")


def check_mcap(path: Path, run_id: str = "") -> list[str]:
    """Check the MCAP file at `path` and return its problems, one sentence each. The list is empty for a good file.

    `run_id` is the name of the run that the file must contain; "" does not check it. No error is raised: a file that is
    missing, cannot be read or is damaged has one problem, and nothing else is checked. Checked are:

    - CRCs of chunks, data and summary.
    - Scenario and labels: present and equal in metadata and attachments.
    - Messages of every topic: each decodes and has the time of its record, and times are in order.
    - Channels: described, with a preview for every quantity.
    - Blocks of samples: no gap, the scenario's sample rate, each block at the time of its first sample. All blocks of a
      channel together have the length in the scenario.
    - Without any problem so far, the rules of `read_mcap`: finite values, existing blades, events within the recording.
    """
    try:
        content = read_content(path)
    except UserError as error:
        return [str(error).removeprefix(f"{path}: ")]
    except OSError as error:
        return [f"cannot be read ({error.strerror})"]
    except DamageError as damage:
        return [f"damaged ({damage})"]
    problems = [*_document_problems(content), *_topic_problems(content), *_sample_problems(content)]
    return problems or _raised(lambda: _check_run(content, run_id))


def _raised(check: Callable[[], object]) -> list[str]:
    """Run a check. Return the message of the DamageError that it raises as a list of one, else an empty list."""
    try:
        check()
    except DamageError as damage:
        return [str(damage)]
    return []


def _check_run(content: McapContent, run_id: str) -> None:
    number = run_number(run_of(content).scenario)
    recorded = "no run that rubgen numbers" if number is None else run_id_of(number)
    if run_id and run_id != recorded:
        raise DamageError(f"holds {recorded}")


def _document_problems(content: McapContent) -> Iterator[str]:
    for name in ("scenario", "labels"):
        record, attachment = content.metadata.get(f"rubgen.{name}"), content.attachments.get(f"{name}.json")
        if record is None or attachment is None:
            yield f"metadata rubgen.{name} or attachment {name}.json is missing"
            continue
        try:
            with damage_found(f"metadata rubgen.{name}"):
                values = {key: read_json(value.encode()) for key, value in record.items()}
            if values != content.document(f"{name}.json"):
                yield f"metadata rubgen.{name} and attachment {name}.json differ"
        except DamageError as damage:
            yield str(damage)


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
        yield from _raised(lambda topic=topic: check_order(content, topic))  # type: ignore[misc]
        yield from _raised(lambda topic=topic: _check_messages(content, topic))  # type: ignore[misc]


def _check_messages(content: McapContent, topic: str) -> None:
    """Decode every message of a topic.

    Raises DamageError where one does not fit, or its time differs from its record's.
    """
    if message_name(topic) is None:
        check_other(content, topic)
        return
    for record, row in zip(content.messages.get(topic, []), decoded(content, topic), strict=True):
        if row.timestamp.seconds * 10**9 + row.timestamp.nanos != record.log_time:
            raise DamageError(f"{topic}: a message of another time than its record at {1e-9 * record.log_time:.6g} s")


def _sample_problems(content: McapContent) -> Iterator[str]:
    try:
        _, scenario = checked_scenario(content)
    except DamageError as damage:
        yield str(damage)
        return
    if not content.topics("/raw/"):
        yield "no channel under /raw"
    for topic in filter(_is_signal, content.channels):
        try:
            yield from _block_problems(content, topic, scenario)
        except DamageError as damage:
            yield str(damage)


def _block_problems(content: McapContent, topic: str, scenario: Scenario) -> Iterator[str]:
    asked = scenario.sensing.sample_rate_hz
    length = 0
    for message in content.messages.get(topic, []):
        with damage_found(f"{topic}: a block"):
            time, rate, first, values = read_sample_block(message.data)
        if rate != asked:
            yield f"{topic}: sample rate {rate:g} is not the scenario's {asked:g}"
            return
        if first != length or time != round(first / rate * 1e9) or time != message.log_time:
            yield f"{topic}: the block at sample {first} does not follow sample {length - 1} in index and time"
        length = first + values.size
    if abs(length - asked * scenario.signal_seconds) > 1:
        yield f"{topic}: {length} samples, the scenario asks {asked * scenario.signal_seconds:g}"


def _is_signal(topic: str) -> bool:
    return topic.startswith(("/raw/", "/clean/"))
