"""Files that are either complete and durable or not there."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable
from pathlib import Path

PART = ".part"
"""End of the name under which a file is written before it is complete."""


def write_durably(path: Path, write: Callable[[Path], object]) -> None:
    """Let `write` make the file under a temporary name, flush it to the disk, then give it its name."""
    part = path.with_name(f"{path.stem}{PART}{path.suffix}")
    try:
        write(part)
        with part.open("rb+") as stream:
            os.fsync(stream.fileno())
        part.replace(path)
        sync_directory(path.parent)
    finally:
        part.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """A text file, durably; UTF-8, line ends as given."""
    write_durably(path, lambda part: part.write_bytes(text.encode()))


def write_json(path: Path, values: object) -> None:
    """A JSON file, durably; keys in their order, numbers with all their bits."""
    write_text(path, json_text(values))


def json_text(values: object) -> str:
    """JSON as rubgen writes it."""
    return json.dumps(values, indent=2, ensure_ascii=False) + "\n"


def sync_directory(directory: Path) -> None:
    """Make the names in a directory durable."""
    descriptor = os.open(directory, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def remove_parts(directory: Path) -> None:
    """Remove what a killed run left half-written."""
    for path in directory.glob(f"**/*{PART}*"):
        if path.is_file():
            path.unlink(missing_ok=True)


def sha256_of(path: Path) -> str:
    """Hexadecimal sha256 of a file's content."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
