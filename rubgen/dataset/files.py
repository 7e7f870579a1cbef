"""Write and hash small files of a data set, and recognise files that do not belong to it."""

import hashlib
import json
from fnmatch import fnmatch
from pathlib import Path

from rubgen.io.files import PART, write_durably

SYSTEM_FILES = (
    ".DS_Store", "._*", ".Spotlight-V100", ".Trashes", ".fseventsd", ".TemporaryItems", ".apdisk",  # macOS
    "Thumbs.db", "ehthumbs.db", "desktop.ini", "$RECYCLE.BIN", "System Volume Information",  # Windows
    "lost+found", ".directory", ".Trash-*", ".nfs*", ".fuse_hidden*", "@eaDir",  # Linux, file servers
)  # fmt: skip
"""Files of operating systems in any directory, in any case. They are ignored."""


def is_system_file(name: str) -> bool:
    """Return whether a file or folder called `name` belongs to the operating system."""
    return any(fnmatch(name.lower(), pattern.lower()) for pattern in SYSTEM_FILES)


def write_text(path: Path, text: str) -> None:
    """Write `text` in UTF-8 with its own line ends, completely and durably or not at all. It replaces an old file."""
    write_durably(path, lambda part: part.write_bytes(text.encode()))


def write_json(path: Path, values: object) -> None:
    """Write `values` to a JSON file, completely and durably or not at all.

    Keys keep their order, floats all their bits.
    """
    write_text(path, json_text(values))


def json_text(values: object) -> str:
    """Return the JSON text of `values`, indented by two spaces, with a line end."""
    return json.dumps(values, indent=2, ensure_ascii=False) + "\n"


def remove_parts(directory: Path) -> None:
    """Delete the incomplete files that a killed process left in the folder `directory`."""
    for path in directory.glob(f"*{PART}*"):
        if path.is_file():
            path.unlink(missing_ok=True)


def sha256_of(path: Path) -> str:
    """Return the sha256 of a file's content in hexadecimal digits."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
