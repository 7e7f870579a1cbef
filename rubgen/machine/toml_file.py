"""TOML files of users: found, read and turned into values, or refused in one line that says how to mend them."""

from __future__ import annotations

import codecs
import re
import stat
import tomllib
from pathlib import Path

from rubgen.errors import UserError
from rubgen.machine.sentences import DECIMAL_COMMA

MOST_BYTES = 2**20
"""A recipe has one or two thousand bytes; a pattern for 1,000 blades 20,000."""
UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
BACKSLASH = re.compile(r'"[^"]*\\[^"]*"')
LINE = re.compile(r"at line (\d+)")


def names_toml(name: str) -> bool:
    """Whether a text is the path of a TOML file rather than the name of something that comes with rubgen."""
    return name.lower().endswith(".toml")


def toml_path(name: str | Path, folder: Path | None = None) -> Path:
    """The path that a user gave, with `~` as the home; a relative one starts from `folder`.

    Raises UserError for a text that cannot be a path.
    """
    text = str(name)
    if any(ord(letter) < 32 for letter in text):
        raise UserError(
            f"{text!r}: a path has no control characters; in TOML write a path with backslashes in single quotes"
        )
    try:
        return (folder or Path()) / Path(text).expanduser()
    except RuntimeError:  # no such user, or no home
        return (folder or Path()) / text


def read_toml(path: Path) -> dict[str, object]:
    """The content of a TOML file; a UserError of one line when it is missing, no text, too large or not TOML.

    A byte order mark of UTF-8 is skipped, and lines may end as on any system.
    """
    path = toml_path(path)
    text = _text(path, _content(path)).replace("\r\n", "\n").replace("\r", "\n")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise UserError(f"{path}: not TOML ({error}); {_remedy(text, str(error))}") from None
    except RecursionError:
        raise UserError(f"{path}: tables or lists in one another without end; write each table once") from None
    except ValueError:  # Python reads integers of up to 4,300 digits
        raise UserError(f"{path}: an integer of thousands of digits; numbers have 64 bits, shorten it") from None


def _content(path: Path) -> bytes:
    """The bytes of a regular file; nothing that could block or never end is opened."""
    try:
        found = path.stat()
        if stat.S_ISDIR(found.st_mode):
            raise UserError(f"{path}: cannot be read, it is a directory; give a TOML file")
        if not stat.S_ISREG(found.st_mode):
            raise UserError(f"{path}: cannot be read, it is no regular file; give a TOML file")
        with path.open("rb") as file:
            content = file.read(MOST_BYTES + 1)
    except (FileNotFoundError, NotADirectoryError):
        raise UserError(f"{path}: there is no such file; check the path") from None
    except OSError as error:
        raise UserError(f"{path}: cannot be read ({error.strerror}); give a readable TOML file") from None
    if len(content) > MOST_BYTES:
        raise UserError(f"{path}: has {found.st_size:,} bytes; give a TOML file of at most {MOST_BYTES:,}")
    return content


def _text(path: Path, content: bytes) -> str:
    if content.startswith(UTF_16):
        raise UserError(f"{path}: a text file in UTF-16; save it in UTF-8")
    if b"\0" in content:
        raise UserError(f"{path}: holds bytes that are zero, as texts in UTF-16 do; save it in UTF-8")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise UserError(f"{path}: not a text file in UTF-8 (line {line}); save it in UTF-8") from None


def _remedy(text: str, error: str) -> str:
    """What to do about a line that is not TOML."""
    found = LINE.search(error)
    lines = text.split("\n")
    line = lines[int(found[1]) - 1] if found else lines[-1]
    value = line.partition("=")[2].strip()
    comma = DECIMAL_COMMA.search(value)
    if BACKSLASH.search(value):
        return "a path with backslashes stands in single quotes, 'C:\\folder\\file.toml', or is written with /"
    if comma:
        return f"decimals have a point, write {comma[1]}.{comma[2]}"
    return "mend the line that is named"
