"""Copy the MCAP file of a run with another scenario, as if it had been written with it."""

from pathlib import Path
from typing import Any

from mcap.records import Attachment, Channel, Message, Schema
from mcap.writer import Writer

from rubgen.errors import UserError
from rubgen.io.files import read_json, write_durably
from rubgen.io.mcap.records import DamageError, read_records
from rubgen.io.mcap.write import new_writer, write_records


def copy_with(source: Path, path: Path, changes: dict[str, Any]) -> None:
    """Write the MCAP file at `source` to `path` with some keys of its scenario changed, complete or not at all.

    `changes` are the keys with their new values. A file at `path` is replaced. The bytes are the bytes that
    `write_mcap` writes for the run with the changed scenario. Raises UserError where `source` is damaged.
    """

    def write(part: Path) -> None:
        with part.open("wb") as stream:
            writer = new_writer(stream)
            _copy(source, writer, changes)
            writer.finish()  # type: ignore[no-untyped-call]  # the mcap package annotates no return type

    try:
        write_durably(path, write)
    except DamageError as damage:
        raise UserError(f"{source}: damaged ({damage}); repair its set: rubgen repair") from None


def _copy(source: Path, writer: Writer, changes: dict[str, Any]) -> None:
    schemas: dict[int, int] = {}
    channels: dict[int, int] = {}
    for record in read_records(source):
        if isinstance(record, Attachment):
            values = read_json(record.data)
            write_records(writer, record.name.removesuffix(".json"), values | (changes if _is_scenario(record) else {}))
        elif isinstance(record, Schema) and record.id not in schemas:  # the summary has all of them again
            schemas[record.id] = writer.register_schema(record.name, record.encoding, record.data)
        elif isinstance(record, Channel) and record.id not in channels:
            channels[record.id] = writer.register_channel(
                record.topic, record.message_encoding, schemas.get(record.schema_id, 0), record.metadata
            )
        elif isinstance(record, Message):
            writer.add_message(
                channels[record.channel_id],
                record.log_time,
                record.data,
                publish_time=record.publish_time,
                sequence=record.sequence,
            )


def _is_scenario(record: Attachment) -> bool:
    return record.name == "scenario.json"
