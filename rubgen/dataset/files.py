"""Small files of a data set, and what keeps its directory clean."""

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
"""What systems put into any directory; in whatever case. It is no content."""


def is_system_file(name: str) -> bool:
    """Whether a file or folder of that name is of the system and not of whoever uses the directory."""
    return any(fnmatch(name.lower(), pattern.lower()) for pattern in SYSTEM_FILES)


def write_text(path: Path, text: str) -> None:
    """A text file, durably; UTF-8, line ends as given."""
    write_durably(path, lambda part: part.write_bytes(text.encode()))


def write_json(path: Path, values: object) -> None:
    """A JSON file, durably; keys in their order, numbers with all their bits."""
    write_text(path, json_text(values))


def json_text(values: object) -> str:
    """JSON as rubgen writes it."""
    return json.dumps(values, indent=2, ensure_ascii=False) + "\n"


def remove_parts(directory: Path) -> None:
    """Remove what a killed run left half-written in this folder."""
    for path in directory.glob(f"*{PART}*"):
        if path.is_file():
            path.unlink(missing_ok=True)


def sha256_of(path: Path) -> str:
    """Hexadecimal sha256 of a file's content."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
