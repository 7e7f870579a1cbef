"""What can still be read of a damaged MCAP file, and what is lost."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

from google.protobuf.message import DecodeError
from mcap.records import Attachment, Channel, Chunk, McapRecord, Message, Metadata
from mcap.stream_reader import StreamReader, breakup_chunk

from rubgen.errors import UserError
from rubgen.io.mcap_read import UNREADABLE, McapContent, McapRun, read_mcap, run_of

MOST_NAMED = 3


def salvage_mcap(path: Path) -> tuple[McapRun, list[str]]:
    """The run in the file at `path`, and what of it is lost, one sentence each: none for a good file.

    Chunks that fail their CRC, and what stands behind the place where the file cannot be followed any more, are left
    out; samples lost that way are NaN. Raises UserError where scenario or labels are lost, or it is no file of rubgen.
    """
    try:
        return read_mcap(path), []
    except UserError as error:
        if not path.is_file():
            raise
        whole = error
    content, lost = _readable(path)
    try:
        return run_of(content, gaps=True), _shortened(lost) or [f"{path}: the damage touches no data that is shown"]
    except (*UNREADABLE, DecodeError):
        raise whole from None


def _readable(path: Path) -> tuple[McapContent, list[str]]:
    """Every record that can be decoded, chunk by chunk, and the losses."""
    content = McapContent(channels={}, messages=defaultdict(list), metadata={}, attachments={})
    topics: dict[int, str] = {}
    messages: list[Message] = []
    lost: list[str] = []
    end = 0
    with path.open("rb") as stream:
        try:
            for record in StreamReader(stream, emit_chunks=True).records:
                for part in _unpacked(record, lost):
                    if isinstance(part, Channel):
                        topics[part.id], content.channels[part.topic] = part.topic, part
                    elif isinstance(part, Message):
                        messages.append(part)
                        end = max(end, part.log_time)
                    elif isinstance(part, Metadata):
                        content.metadata[part.name] = part.metadata
                    elif isinstance(part, Attachment):
                        content.attachments[part.name] = part.data
        except UNREADABLE:
            lost.append(f"the file cannot be followed to its end; the last message read stands at {1e-9 * end:.3g} s")
    for message in messages:
        if message.channel_id in topics:
            content.messages[topics[message.channel_id]].append(message)
    return content, lost


def _unpacked(record: McapRecord, lost: list[str]) -> list[McapRecord]:
    """The records of a chunk, none of a damaged one; any other record is itself."""
    if not isinstance(record, Chunk):
        return [record]
    try:
        return breakup_chunk(record, validate_crc=True)
    except UNREADABLE:
        start, end = (1e-9 * time for time in (record.message_start_time, record.message_end_time))
        lost.append(f"everything between {start:.3g} and {end:.3g} s")
        return []


def _shortened(lost: list[str]) -> list[str]:
    more = len(lost) - MOST_NAMED
    return lost[:MOST_NAMED] + ([f"and {more} more pieces"] if more > 0 else [])
