"""MCAP files that are well-formed and wrong: every record of a good one, changed, written with the real writer."""

from dataclasses import dataclass, field
from pathlib import Path

from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer


@dataclass
class Parts:
    """What a file is made of; lists and tables to change."""

    schemas: dict[int, tuple[str, str, bytes]] = field(default_factory=dict)
    channels: list[list] = field(default_factory=list)  # [topic, encoding, schema, metadata]
    messages: list[list] = field(default_factory=list)  # [number of the channel, time, data]
    metadata: list[list] = field(default_factory=list)  # [name, table]
    attachments: list[list] = field(default_factory=list)  # [name, bytes]

    def of(self, topic: str) -> list[list]:
        """The messages of a topic."""
        (number,) = [i for i, channel in enumerate(self.channels) if channel[0] == topic]
        return [message for message in self.messages if message[0] == number]

    def channel(self, topic: str) -> list:
        return next(channel for channel in self.channels if channel[0] == topic)

    def attachment(self, name: str) -> list:
        return next(each for each in self.attachments if each[0] == name)


def parts_of(path: Path) -> Parts:
    parts, numbers = Parts(), {}
    with path.open("rb") as stream:
        reader = make_reader(stream)
        summary = reader.get_summary()
        for number, schema in summary.schemas.items():
            parts.schemas[number] = (schema.name, schema.encoding, schema.data)
        for position, channel in enumerate(summary.channels.values()):
            numbers[channel.id] = position
            parts.channels.append([channel.topic, channel.message_encoding, channel.schema_id, channel.metadata])
        for _, channel, message in reader.iter_messages(log_time_order=False):
            parts.messages.append([numbers[channel.id], message.log_time, message.data])
        parts.metadata = [[each.name, each.metadata] for each in reader.iter_metadata()]
        parts.attachments = [[each.name, each.data] for each in reader.iter_attachments()]
    return parts


def write_parts(parts: Parts, path: Path, **settings) -> None:
    with path.open("wb") as stream:
        writer = Writer(stream, **{"compression": CompressionType.ZSTD, "enable_data_crcs": True, **settings})
        writer.start(profile="", library="somebody")
        for name, table in parts.metadata:
            writer.add_metadata(name, table)
        for name, data in parts.attachments:
            writer.add_attachment(0, 0, name, "application/json", data)
        schemas = {number: writer.register_schema(*schema) for number, schema in parts.schemas.items()}
        ids = [
            writer.register_channel(topic, encoding, schemas[schema], metadata)
            for topic, encoding, schema, metadata in parts.channels
        ]
        for channel, time, data in parts.messages:
            writer.add_message(ids[channel], time, data, publish_time=time, sequence=0)
        writer.finish()
