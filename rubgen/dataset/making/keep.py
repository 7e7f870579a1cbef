"""Keep finished runs of an open shard: rows are appended to a file as runs finish, so that a kill loses only one.

A record is a checksum, the number of the run, whether it ended well, and a message of Arrow for each table. A run that
begins leaves a record without rows: where a worker died, it tells which run was being made. Damaged records are left
out, and their runs made again.
"""

import shutil
import struct
import zlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from uuid import uuid4

import pyarrow as pa

from rubgen.dataset.layout import Layout
from rubgen.dataset.tables import RUNS, SetTable, tables_of

_HEAD = struct.Struct("<4sIQ?Q")
_MARK = b"rub1"
_LENGTH = struct.Struct("<Q")


@dataclass(frozen=True, kw_only=True)
class Kept:
    """The position of a finished run's rows in a file of kept runs."""

    file: Path
    start: int
    length: int
    good: bool
    """Whether the run ended well, so that it has a row in every table."""


class Keeper:
    """Appends runs to a file of its own in the folder of an open shard. Two workers never write to the same file."""

    def __init__(self, layout: Layout, shard: str, session: str) -> None:
        """Name the file after the session, the call of `generate` that the work belongs to. It is made on first use."""
        self._file = layout.kept(shard) / f"{session}-{uuid4().hex[:12]}.kept"

    def begin(self, index: int) -> None:
        """Write a record that run number `index` begins."""
        self._append(index, good=False, content=b"")

    def keep(self, index: int, rows: Sequence[pa.Table | None]) -> None:
        """Append the rows of finished run `index`: its row of `runs`, then its rows of each table.

        A failed run has None in the place of each missing row.
        """
        parts = [b"" if row is None else _message(row) for row in rows]
        content = b"".join(_LENGTH.pack(len(part)) + part for part in parts)
        self._append(index, good=all(row is not None for row in rows), content=content)

    def _append(self, index: int, *, good: bool, content: bytes) -> None:
        self._file.parent.mkdir(parents=True, exist_ok=True)
        head = _HEAD.pack(_MARK, zlib.crc32(content, index), index, good, len(content))
        with self._file.open("ab") as stream:
            stream.write(head + content)


def _message(row: pa.Table) -> bytes:
    (batch,) = row.combine_chunks().to_batches() or [pa.RecordBatch.from_pylist([], row.schema)]
    return bytes(batch.serialize())


def kept_runs(layout: Layout, shard: str) -> dict[int, Kept]:
    """Return the finished runs of an open shard by their numbers, failed runs included.

    Of a run that was made twice, the one in the first file by name is used. Damaged records are left out.
    """
    found: dict[int, Kept] = {}
    for file in sorted(layout.kept(shard).glob("*.kept")):
        for index, kept in _records(file):
            if kept.length:
                found.setdefault(index, kept)
    return found


def runs_of_session(layout: Layout, shard: str, session: str) -> tuple[set[int], set[int]]:
    """Return the numbers of the runs that this session kept, and of the runs that it began and did not keep.

    A session is one call of `generate`. The worker of a run that was begun and not kept has died, or is still at work.
    """
    kept: set[int] = set()
    begun: set[int] = set()
    for file in layout.kept(shard).glob(f"{session}-*.kept"):
        for index, record in _records(file):
            (kept if record.length else begun).add(index)
    return kept, begun - kept


def _records(file: Path) -> Iterator[tuple[int, Kept]]:
    """Yield the records of a file up to the first that is not whole."""
    with file.open("rb") as stream:
        while len(head := stream.read(_HEAD.size)) == _HEAD.size:
            mark, checksum, index, good, length = _HEAD.unpack(head)
            start = stream.tell()
            content = stream.read(length) if mark == _MARK and start + length <= file.stat().st_size else b""
            if mark != _MARK or len(content) != length or zlib.crc32(content, index) != checksum:
                return
            yield index, Kept(file=file, start=start, length=length, good=good)


def rows_of(
    kept: Iterable[Kept], table: SetTable, types: pa.Schema, formats: Sequence[str]
) -> Iterator[pa.RecordBatch]:
    """Yield the rows of kept runs in one table, as record batches. Runs without a row in the table are left out.

    - kept: the runs, in the order of the rows.
    - table: a table of the set, from `dataset.tables`, such as RUNS.
    - types: the table's schema.
    - formats: the formats of the set, which determine its tables.
    """
    place = [RUNS.name, *(each.name for each in tables_of(formats))].index(table.name)
    for each in kept:
        with each.file.open("rb") as stream:
            stream.seek(each.start)
            for _ in range(place):
                stream.seek(_LENGTH.unpack(stream.read(_LENGTH.size))[0], 1)
            (length,) = _LENGTH.unpack(stream.read(_LENGTH.size))
            if length:
                yield pa.ipc.read_record_batch(pa.py_buffer(stream.read(length)), types)


def remove_kept(layout: Layout, shard: str) -> None:
    """Delete the kept rows of a closed shard."""
    shutil.rmtree(layout.kept(shard), ignore_errors=True)
