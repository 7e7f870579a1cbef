"""The records of an MCAP file in file order, each with its framing, size and checksum checked.

The mcap package parses single records. It trusts their lengths, leaves the summary's CRC unchecked, and unpacks a chunk
to whatever size the chunk names.
"""

import struct
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import IO

import zstandard
from google.protobuf.message import DecodeError
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Chunk, DataEnd, Footer, McapRecord, Message, Metadata, Schema

from rubgen.errors import RubgenError
from rubgen.io.files import check_regular

MOST_CHUNK_BYTES = 64 * 1024**2
"""Largest chunk. rubgen writes chunks of 0.5 MiB; other writers some MiB."""
MOST_BYTES = 256 * 1024**2
"""Unpacked size of all chunks that is allowed for any file: eighty seconds and 30 channels need as much."""
MOST_TIMES = 400
"""Largest ratio of unpacked size to size of a larger file. Each message has an index entry of 16 bytes that is not
packed: blocks of 4 kB of zeros have a ratio of 250."""
MAGIC = b"\x89MCAP0\r\n"
_HEAD = struct.Struct("<BQ")  # opcode, length
_MESSAGE = struct.Struct("<HIQQ")  # channel, sequence, log time, publish time
_RECORD_CLASSES = {
    Opcode.CHANNEL: Channel,
    Opcode.CHUNK: Chunk,
    Opcode.METADATA: Metadata,
    Opcode.ATTACHMENT: Attachment,
    Opcode.SCHEMA: Schema,
}
_PARSERS_RAISE = (
    McapError, zstandard.ZstdError, DecodeError, struct.error, ValueError, LookupError, ArithmeticError, EOFError,
    RecursionError, MemoryError,
)  # fmt: skip


class DamageError(RubgenError):
    """Damage of an MCAP file. The message does not contain the name of the file."""


@contextmanager
def damage_found(what: str) -> Iterator[None]:
    """Turn any error of a parser in the block into a `DamageError`: "`what` cannot be read (...)"."""
    try:
        yield
    except _PARSERS_RAISE as error:
        reason = " ".join(f"{type(error).__name__} {error}".split())[:200]
        raise DamageError(f"{what} cannot be read ({reason})") from None


def read_records(path: Path, lost: list[str] | None = None) -> Iterator[McapRecord]:
    """Yield schemas, channels, messages, metadata and attachments in file order, including records within chunks.

    Raises DamageError where a record, a size or a CRC is wrong. If a list `lost` is given, damaged parts are left out
    instead, a text about each part is appended to `lost`, and the CRCs of the whole file are not checked. DamageError
    is then raised only for a file that does not begin like MCAP. Raises UserError or OSError where the file cannot be
    read at all.
    """
    size = check_regular(path)
    with path.open("rb") as stream:
        yield from _Reading(stream, size, lost).records()


class _Reading:
    """One pass through a file.

    `place` is the next byte, `record_start` the start of the last record, `unpacked` the bytes of all chunks so far.
    """

    def __init__(self, stream: IO[bytes], size: int, lost: list[str] | None) -> None:
        self.stream, self.size, self.lost = stream, size, lost
        self.place = self.record_start = self.unpacked = 0
        self.last_time = 0

    def records(self) -> Iterator[McapRecord]:
        if self._take(len(MAGIC)) != MAGIC:
            raise DamageError("does not begin like an MCAP file")
        try:
            for opcode, body in self._framed():
                yield from self._parsed(opcode, body)
        except DamageError:
            if self.lost is None:
                raise
            end = f"the last message read stands at {1e-9 * self.last_time:.3g} s"
            self.lost.append(f"the file cannot be followed to its end; {end}")

    def _framed(self) -> Iterator[tuple[int, bytes]]:
        """Opcode and body of each record up to the footer. The CRCs of data and summary are compared on the way."""
        crc = zlib.crc32(MAGIC)
        summary_start = 0
        while True:
            start = self.place
            head = self._take(_HEAD.size)
            opcode, length = _HEAD.unpack(head)
            body = self._take(length)
            if opcode == Opcode.FOOTER:
                self._check_footer(head, body, crc, summary_start)
                return
            if opcode == Opcode.DATA_END:
                self._check_crc("data section", DataEnd.read(_stream(body)).data_section_crc, crc)
                crc, summary_start = 0, self.place
            else:
                crc = zlib.crc32(body, zlib.crc32(head, crc))
                self.record_start = start
                yield opcode, body

    def _take(self, length: int) -> bytes:
        if length > MOST_BYTES:
            raise DamageError(f"a record of {length:,} bytes is asked for; {MOST_BYTES:,} are allowed")
        if length > self.size - self.place:
            raise DamageError(f"{length:,} bytes are asked for at byte {self.place:,}, the file has {self.size:,}")
        data = self.stream.read(length)
        self.place += len(data)
        if len(data) != length:
            raise DamageError("became shorter while it was read")
        return data

    def _check_crc(self, what: str, written: int, found: int) -> None:
        if written not in (0, found) and self.lost is None:  # 0: the writer made none
            raise DamageError(f"crc of the {what} is wrong")

    def _check_footer(self, head: bytes, body: bytes, crc: int, summary_start: int) -> None:
        with damage_found("the footer"):
            footer = Footer.read(_stream(body))
        self._check_crc("summary", footer.summary_crc, zlib.crc32(body[:-4], zlib.crc32(head, crc)))
        if self.lost is None and footer.summary_start not in (0, summary_start):
            raise DamageError("the footer names another place for the summary")
        if self._take(len(MAGIC)) != MAGIC or (self.place != self.size and self.lost is None):
            raise DamageError("does not end like an MCAP file")

    def _parsed(self, opcode: int, body: bytes) -> list[McapRecord]:
        """Return the records of a chunk, or the single record of this body; none of a kind that is not used here."""
        what = f"the record at byte {self.record_start:,}"
        try:
            with damage_found(what):
                record = _record(opcode, body)
                if isinstance(record, Chunk):
                    times = (1e-9 * time for time in (record.message_start_time, record.message_end_time))
                    what = "everything between {:.3g} and {:.3g} s".format(*times)
                    return self._unpacked(record)
                if isinstance(record, Message):
                    self.last_time = max(self.last_time, record.log_time)
                return [record] if record else []
        except DamageError:
            if self.lost is None:
                raise
            self.lost.append(what)
            return []

    def _unpacked(self, chunk: Chunk) -> list[McapRecord]:
        data = _content(chunk)
        self.unpacked += len(data)
        if self.unpacked > max(MOST_BYTES, MOST_TIMES * self.size):
            raise DamageError(f"unpacks to more than {MOST_BYTES:,} bytes")
        records: list[McapRecord] = []
        place = 0
        while place < len(data):
            opcode, length = _HEAD.unpack_from(data, place)
            place += _HEAD.size
            if length > len(data) - place:
                raise DamageError(f"a record of {length:,} bytes does not fit in its chunk")
            record = _record(opcode, data[place : place + length])
            place += length
            if isinstance(record, Message):
                self.last_time = max(self.last_time, record.log_time)
            if isinstance(record, Message | Channel | Schema):
                records.append(record)
        return records


def _content(chunk: Chunk) -> bytes:
    """Unpack a chunk. Its size is checked against the bound before, and against its header after."""
    size = chunk.uncompressed_size
    if size > MOST_CHUNK_BYTES:
        raise DamageError(f"a chunk would unpack to {size:,} bytes; {MOST_CHUNK_BYTES:,} are allowed")
    data = chunk.data
    if chunk.compression == "zstd":
        if zstandard.frame_content_size(data) not in (-1, size):
            raise DamageError("a chunk names one size, its content another")
        data = zstandard.ZstdDecompressor().decompress(data, max_output_size=size)
    elif chunk.compression:
        raise DamageError(f"a chunk is compressed by {chunk.compression!r:.40}; rubgen reads zstd")
    if len(data) != size:
        raise DamageError("a chunk names one size, its content another")
    if chunk.uncompressed_crc not in (0, zlib.crc32(data)):
        raise DamageError("crc of a chunk is wrong")
    return data


def _record(opcode: int, body: bytes) -> McapRecord | None:
    if opcode == Opcode.MESSAGE:
        channel_id, sequence, log_time, publish_time = _MESSAGE.unpack_from(body)
        return Message(channel_id, log_time, body[_MESSAGE.size :], publish_time, sequence)
    kind = _RECORD_CLASSES.get(opcode)  # type: ignore[call-overload]
    return kind.read(_stream(body)) if kind else None


def _stream(body: bytes) -> ReadDataStream:
    return ReadDataStream(BytesIO(body))
