"""Find and read users' TOML files and turn them into values, or refuse them in one line with the remedy."""

import codecs
import os
import re
import stat
import tomllib
from pathlib import Path

from rubgen.errors import UserError
from rubgen.machine.sentences import DECIMAL_COMMA

MOST_BYTES = 2**20
"""Largest size of a file. A recipe has one or two thousand bytes; a pattern for 1,000 blades has 20,000."""
MARKS = {
    codecs.BOM_UTF32_LE: "UTF-32",
    codecs.BOM_UTF32_BE: "UTF-32",
    codecs.BOM_UTF16_LE: "UTF-16",
    codecs.BOM_UTF16_BE: "UTF-16",
}
"""Byte order marks. UTF-32 stands before UTF-16, because its mark begins with the mark of UTF-16."""
LINE = re.compile(r"at line (\d+)")
SHOWN = 80
"""Letters of a bad line that are shown."""
KEYS_OF_KIND = {
    "recipe": ("runs", "vary", "machine", "simulation", "operation", "output"),
    "machine": ("disk", "blades", "casing", "disk_support", "damping"),
    "sensor set": ("kinds", "shaft_runout"),
}
"""Tables and keys that exist only in one kind of file."""
BACKSLASH = re.compile(r'"[^"]*\\[^"]*"')
CURVED_QUOTES = re.compile("[“”„‘’«»]")
SWITCH = re.compile(r"true|false|yes|no|on|off", re.IGNORECASE)
NOTHING = re.compile(r"none|null|nil|nan\w+", re.IGNORECASE)
COMMENTS = ("//", "/*", ";", "--", "%")
TWICE = ("Cannot ", "Duplicate ")
UNCLOSED = {
    "Unclosed array": "close the list with ], with a comma between its values",
    "Unclosed inline table": "close the table with }, with a comma between its values",
}


def names_toml(name: str) -> bool:
    """Return whether a text is the path of a TOML file and not the name of a preset: whether it ends with .toml."""
    return name.lower().endswith(".toml")


def toml_path(name: str | Path, folder: Path | None = None) -> Path:
    """Return the path `name` of a user, with `~` as the home directory. A relative path starts from `folder`.

    `folder` None is the current directory. The file need not exist. Raises UserError for a text with control
    characters.
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


def named_toml(key: str, name: str, folder: Path | None = None) -> Path:
    """Return the path of the TOML file `name`, with `~` as the home directory. A relative path starts from `folder`.

    `folder` None is the current directory. Raises UserError where nothing is at the path; `key` is the key whose value
    `name` is, for the message. What is at the path, such as a directory, is not checked. Raises UserError as
    `toml_path` too.
    """
    path = toml_path(name, folder)
    if os.path.lexists(path):
        return path
    hint = "$HOME and its like are not replaced, write ~ or the whole path" if "$" in name else "check the path"
    raise UserError(f"{key} = {name!r}: {path}: there is no such file; {hint}")


def check_kind(path: Path | str, data: dict[str, object], wanted: str) -> None:
    """Check that the content of a TOML file is of the kind `wanted`: "recipe", "machine" or "sensor set".

    - path: path of the file, for the message.
    - data: its content.

    Raises UserError where the content is clearly of another kind: it has no key of `wanted` in KEYS_OF_KIND, and two or
    more of another kind, or a list `sensors`. All other content passes, also without any known key.
    """
    if any(key in data for key in KEYS_OF_KIND[wanted]):
        return
    for kind, keys in KEYS_OF_KIND.items():
        listed = kind == "sensor set" and isinstance(data.get("sensors"), list)
        if kind != wanted and (listed or sum(key in data for key in keys) > 1):
            raise UserError(f"{path}: this is a {kind}, no {wanted}; give the TOML file of a {wanted}")


def read_toml(path: Path) -> dict[str, object]:
    """Read a TOML file and return its values. `~` in `path` is the home directory.

    A byte order mark of UTF-8 is skipped. Lines may end as on any system. Raises UserError of one line where the file
    is missing, not a readable regular file, larger than MOST_BYTES, not a text in UTF-8, or not TOML.
    """
    path = toml_path(path)
    text = _text(path, _content(path)).replace("\r\n", "\n").replace("\r", "\n")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise UserError(f"{path}: {_not_toml(text, str(error))}") from None
    except RecursionError:
        raise UserError(f"{path}: tables or lists in one another without end; write each table once") from None
    except ValueError:  # Python reads integers of up to 4,300 digits
        raise UserError(f"{path}: an integer of thousands of digits; numbers have 64 bits, shorten it") from None


def _content(path: Path) -> bytes:
    """Return the bytes of a regular file. Raises UserError for other files: opening them may block or never end."""
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
    for mark, name in MARKS.items():
        if content.startswith(mark):
            raise UserError(f"{path}: a text file in {name}; save it in UTF-8")
    if b"\0" in content:
        raise UserError(f"{path}: holds bytes that are zero, as texts in UTF-16 or UTF-32 do; save it in UTF-8")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise UserError(f"{path}: not a text file in UTF-8 (line {line}); save it in UTF-8") from None


def _not_toml(text: str, error: str) -> str:
    """Return the line that is not TOML, and the remedy."""
    found = LINE.search(error)
    lines = text.rstrip().split("\n")
    number = min(int(found[1]), len(lines)) if found else len(lines)
    line = lines[number - 1]
    shown = "".join(letter if letter.isprintable() else "?" for letter in line.strip())[:SHOWN]
    return f"line {number} is not TOML, {shown}: {remedy(line, error)}"


def remedy(line: str, error: str) -> str:
    """Return what to write instead of a line that is not TOML. `error` is the message of the parser."""
    value = line.partition("=")[2].strip()
    return _of_whole_line(line.strip(), value, error) or _of_value(value) or "write key = value, texts in quotes"


def _of_whole_line(line: str, value: str, error: str) -> str:
    if BACKSLASH.search(value):
        return "a path with backslashes stands in single quotes, 'C:\\folder\\file.toml', or is written with /"
    if error.startswith(TWICE):
        return "this key or table is given twice; keep one of them"
    if CURVED_QUOTES.search(line):
        return "quotes are straight, \"text\" or 'text'"
    if line.startswith(COMMENTS):
        return "a comment begins with #"
    if line.startswith("["):
        return "a table begins with its name in square brackets, [name]"
    if "=" not in line:
        return "write key = value"
    return next((words for start, words in UNCLOSED.items() if error.startswith(start)), "")


def _of_value(value: str) -> str:
    comma = DECIMAL_COMMA.search(value)
    if comma:
        thousands = f", thousands have no comma, write {comma[1]}{comma[2]}" if len(comma[2]) == 3 else ""
        return f"decimals have a point, write {comma[1]}.{comma[2]}{thousands}"
    if SWITCH.fullmatch(value):
        return "write true or false, in small letters"
    if NOTHING.fullmatch(value):
        return "leave the key out"
    if value.startswith(('"', "'")):
        return "close the text with the quotes that it begins with, and write nothing behind it"
    if "(" in value:
        return "a list stands in square brackets, [1, 2]"
    if value.startswith("{"):
        return "a table in braces stands in one line, with a comma between its values and none at its end"
    return _of_number(value) or ('a text stands in quotes, "text"' if value[:1].isalpha() else "")


def _of_number(value: str) -> str:
    if re.match(r"[-+]?\.\d", value) or re.match(r"[-+]?\d+\.(\D|$)", value):
        return "a number has digits on both sides of its point, 0.5 or 5.0"
    if re.match(r"[-+]?0\d", value):
        return "a number has no zero in front"
    return "give one number alone; its unit stands in the name of the key" if re.match(r"[-+]?\d", value) else ""
