"""Files that are either complete and durable or not there."""

import errno
import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

PART = ".part"
"""End of the name under which a file is written before it is complete."""
_OF_WRITING = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EROFS)
"""Errors that a write to an open file ends with; they name no file."""
_NO_SYNC = (errno.EBADF, errno.EINVAL, errno.ENOSYS, errno.ENOTSUP)
"""What file systems answer that cannot flush a directory."""


def write_durably(path: Path, write: Callable[[Path], object]) -> None:
    """Let `write` make the file under a temporary name, flush it to the disk, then give it its name.

    Whatever `write` raises passes on; then no file is there, or the one from before. An OSError of the file itself
    names `path`: one at the temporary file, or one that names no file and is of a kind that only writing has.
    """
    part = path.with_name(f"{path.stem}{PART}{path.suffix}")
    try:
        write(part)
        with part.open("rb+") as stream:
            os.fsync(stream.fileno())
        part.replace(path)
        sync_directory(path.parent)
    except OSError as error:
        ours = error.errno in _OF_WRITING if error.filename is None else str(error.filename).startswith(str(part))
        if not ours or error.errno is None:
            raise
        raise OSError(error.errno, error.strerror, str(path)) from error
    finally:
        with suppress(OSError):  # it is there only after another error, which says more
            part.unlink()


def sync_directory(directory: Path) -> None:
    """Make the names in a directory durable, where the system can; an OSError names the directory."""
    try:
        descriptor = os.open(directory, os.O_RDONLY)
    except PermissionError:  # Windows opens no directory
        return
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in _NO_SYNC:
            raise OSError(error.errno, error.strerror, str(directory)) from error
    finally:
        os.close(descriptor)
