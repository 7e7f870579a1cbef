"""Small files of a data set, and files that do not belong to it."""

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
    """Whether a file or folder of that name belongs to the operating system."""
    return any(fnmatch(name.lower(), pattern.lower()) for pattern in SYSTEM_FILES)


def write_text(path: Path, text: str) -> None:
    """Write a text file durably; UTF-8, line ends as given."""
    write_durably(path, lambda part: part.write_bytes(text.encode()))


def write_json(path: Path, values: object) -> None:
    """Write a JSON file durably; keys in their order, numbers with all their bits."""
    write_text(path, json_text(values))


def json_text(values: object) -> str:
    """JSON in the form of rubgen's files."""
    return json.dumps(values, indent=2, ensure_ascii=False) + "\n"


def remove_parts(directory: Path) -> None:
    """Remove incomplete files of a killed run from this folder."""
    for path in directory.glob(f"*{PART}*"):
        if path.is_file():
            path.unlink(missing_ok=True)


def sha256_of(path: Path) -> str:
    """Hexadecimal sha256 of a file's content."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
