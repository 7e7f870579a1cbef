"""Files that are either complete and durable or not there."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

PART = ".part"
"""End of the name under which a file is written before it is complete."""


def write_durably(path: Path, write: Callable[[Path], object]) -> None:
    """Let `write` make the file under a temporary name, flush it to the disk, then give it its name.

    Whatever `write` raises passes on, an OSError of the disk too; then no file is there, or the one from before.
    """
    part = path.with_name(f"{path.stem}{PART}{path.suffix}")
    try:
        write(part)
        with part.open("rb+") as stream:
            os.fsync(stream.fileno())
        part.replace(path)
        sync_directory(path.parent)
    finally:
        part.unlink(missing_ok=True)


def sync_directory(directory: Path) -> None:
    """Make the names in a directory durable."""
    descriptor = os.open(directory, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
