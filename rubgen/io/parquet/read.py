"""Tables from Parquet files. A damaged file is a UserError of one line that names it, never a wrong value."""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.fs as pafs
import pyarrow.parquet as pq

from rubgen.errors import UserError
from rubgen.io.files import check_regular
from rubgen.io.parquet.features import is_list
from rubgen.io.places import is_url, url_problems

MOST_BYTES = 256 * 1024**2
"""Unpacked size that is allowed for any row group: eight runs of ten seconds and 30 channels need as much."""
MOST_TIMES = 1000
"""Largest ratio of the unpacked size of a larger row group to its size in the file. The size that its recipe asks for
is allowed too: signals without noise that repeat every turn have a ratio of 5,000, constant ones of 20,000."""

NO_PARQUET = "damaged or no Parquet file of rubgen"


class ParquetSource:
    """An open Parquet file of rubgen. Any damage raises a UserError that names the file.

    Page checksums, UTF-8 and offsets are checked. Sizes are checked before unpacking, so that a small file cannot fill
    the memory.
    """

    def __init__(self, path: Path, asked_bytes: float = 0.0) -> None:
        """Open the file and read its footer.

        `asked_bytes` is the unpacked size of a row group that the recipe of the data set leads one to expect, if known.
        It is allowed beyond the general bound. Raises UserError where the file is missing, damaged or has columns of
        unknown types.
        """
        self.path, self._asked_bytes = path, asked_bytes
        self._size = check_regular(path)
        with damage_named(path):
            self._stream = _opened(path)
            with pq.ParquetFile(self._stream) as footer:
                facts = footer.metadata
                self.schema_arrow: pa.Schema = footer.schema_arrow.remove_metadata()
            self.num_row_groups: int = facts.num_row_groups
            self._text = _text_columns(path, self.schema_arrow)
            self._file = pq.ParquetFile(
                self._stream, metadata=facts, read_dictionary=list(self._text.values()), page_checksum_verification=True
            )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()
        self._stream.close()

    def rows_of(self, group: int) -> int:
        """Return the number of rows of row group `group`, from the footer."""
        return int(self._file.metadata.row_group(group).num_rows)

    def read_row_group(self, group: int, columns: Sequence[str] | None = None) -> pa.Table:
        """Read the rows of row group `group`. `columns` are the names of the columns to read; None reads all.

        Raises UserError where a page is damaged or a column is missing.
        """
        names = self._names(columns)
        with damage_named(self.path):
            self._check_size(group)
            return self._plain(self._file.read_row_group(group, columns=names), names)

    def read(self, columns: Sequence[str] | None = None) -> pa.Table:
        """Read all rows. `columns` are the names of the columns to read; None reads all.

        Raises UserError where a page is damaged or a column is missing.
        """
        groups = [self.read_row_group(group, columns) for group in range(self.num_row_groups)]
        types = pa.schema([self.schema_arrow.field(name) for name in self._names(columns)])
        return pa.concat_tables([types.empty_table(), *groups])

    def _names(self, columns: Sequence[str] | None) -> list[str]:
        there = self.schema_arrow.names
        missing = [name for name in columns or () if name not in there]
        if missing:
            unlike = f"damaged or of another rubgen: it has no column {missing[0]!r}"
            raise UserError(f"{self.path}: {unlike}; run rubgen verify on its set")
        return list(there if columns is None else columns)

    def _check_size(self, group: int) -> None:
        """Compare the group's size in the footer with the size of the file.

        Sizes of single columns are not read: pyarrow ends the process where they are damaged.
        """
        facts = self._file.metadata.row_group(group)
        unpacked = max(facts.total_byte_size, 8 * facts.num_rows * len(self.schema_arrow))
        self._refuse_above(unpacked, self._size, self._asked_bytes)

    def _plain(self, table: pa.Table, names: list[str]) -> pa.Table:
        """Return the table with text as text.

        It was read as a dictionary, since a long word may be repeated a million times.
        """
        text = [chunk for name in names if name in self._text for chunk in table[name].chunks]
        table.validate(full=True)
        self._refuse_above(sum(_text_bytes(chunk) for chunk in text), 0)
        return table.cast(pa.schema([self.schema_arrow.field(name) for name in names]))

    def _refuse_above(self, unpacked: int, packed: int, asked: float = 0.0) -> None:
        if unpacked > max(MOST_BYTES, MOST_TIMES * packed) + asked:
            raise UserError(f"{self.path}: would unpack to {unpacked:,} bytes; that is no file of rubgen")


def read_table(path: Path, columns: Sequence[str] | None = None) -> pa.Table:
    """Read all rows of the Parquet file at `path`, with every page checked.

    - columns: names of the columns to read; None reads all.

    Raises UserError where the file is missing or damaged, or a column is missing.
    """
    with ParquetSource(path) as file:
        return file.read(columns)


def row_groups(path: Path, asked_bytes: float = 0.0, columns: Sequence[str] | None = None) -> Iterator[pa.Table]:
    """Yield the row groups of the Parquet file at `path` one by one, with every page checked.

    - asked_bytes: expected unpacked size of a row group, allowed beyond the general bound of 256 MiB.
    - columns: names of the columns to read; None reads all.

    Only one row group is in memory. Raises UserError where the file is missing or damaged, or a column is missing.
    """
    with ParquetSource(path, asked_bytes) as file:
        for group in range(file.num_row_groups):
            yield file.read_row_group(group, columns)


def _opened(path: Path) -> pa.NativeFile:
    """Open a file, or an object at a URL, of which pyarrow then asks for the pieces that it needs."""
    if not is_url(path):
        return pa.OSFile(os.fsencode(path))  # the bytes of a name that is no UTF-8 too
    there: Any = path
    with url_problems(path):
        return pafs.PyFileSystem(pafs.FSSpecHandler(there.fs)).open_input_file(there.path)


@contextmanager
def damage_named(path: Path) -> Iterator[None]:
    """Turn an error of pyarrow in the block into a UserError of one line that names the file `path`.

    pyarrow reports damage by its own exceptions, by an OSError without a number, and for names of columns by a
    UnicodeDecodeError: the message calls the file damaged. An OSError with a number and a MemoryError come from the
    system: the message says that the file cannot be read. Any other error of a file passes: it is a bug. At a URL every
    Exception is turned (`url_problems`).
    """
    with url_problems(path) if is_url(path) else nullcontext():
        try:
            yield
        except (pa.ArrowException, OSError, UnicodeDecodeError, MemoryError) as error:
            reason = " ".join(str(error).split())[:200]
            if isinstance(error, OSError) and error.errno:
                raise UserError(f"{path}: cannot be read ({os.strerror(error.errno)})") from None
            if isinstance(error, MemoryError):
                raise UserError(f"{path}: cannot be read ({reason or 'memory ran out'})") from None
            raise UserError(f"{path}: {NO_PARQUET} ({reason}); generate it again") from None


def _text_columns(path: Path, types: pa.Schema) -> dict[str, str]:
    """Return the columns of texts and of lists of texts, each with the name of its leaf.

    Raises UserError where two columns share a name, or one has a type that rubgen never writes.
    """
    if len(set(types.names)) != len(types.names):
        raise UserError(f"{path}: two columns share a name; that is no file of rubgen")
    for field in types:
        leaf = field.type.value_type if is_list(field.type) else field.type
        number = pa.types.is_integer(leaf) or pa.types.is_floating(leaf) or pa.types.is_boolean(leaf)
        if not (number or pa.types.is_string(leaf)):
            raise UserError(f"{path}: column {field.name!r} is {field.type!s:.60}; that is no file of rubgen")
    lists = [
        field.name for field in types if pa.types.is_list(field.type) and pa.types.is_string(field.type.value_type)
    ]
    text = [field.name for field in types if pa.types.is_string(field.type)]
    return {name: name for name in text} | {name: f"{name}.list.element" for name in lists}


def _text_bytes(chunk: pa.Array) -> int:
    words = chunk.flatten() if pa.types.is_list(chunk.type) else chunk
    lengths = pc.take(pc.binary_length(words.dictionary), words.indices)
    return int(pc.sum(lengths).as_py() or 0)
