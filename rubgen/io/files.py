"""Safe reading of files of unknown origin, and writing that is complete and durable or leaves no file."""

import errno
import json
import os
import stat
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from rubgen.errors import UserError

PART = ".part"
"""Ending of the name of a file that is not complete yet."""
_OF_WRITING = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EROFS)
"""Errors of a write to an open file. They name no file."""
_NO_SYNC = (errno.EBADF, errno.EINVAL, errno.ENOSYS, errno.ENOTSUP)
"""Errors of file systems that cannot flush a directory."""


def write_durably(path: Path, write: Callable[[Path], object]) -> None:
    """Call `write` with a temporary path, flush the file that it writes to the disk, then rename the file to `path`.

    A file at `path` is replaced; its folder must exist. The temporary file lies in the same folder, has the same
    suffix, and is removed in any case.

    If `write` raises an error, it is raised again, and `path` is unchanged. An OSError at the temporary file, or an
    OSError without a file name that only writing can cause, names `path`.
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
    """Flush the names in a directory to the disk, if the system can. Raises an OSError that names the directory."""
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


def check_regular(path: Path) -> int:
    """Check that `path` is a regular file and return its size in bytes.

    Raises UserError where it does not exist, or is a folder, a pipe or a device: opening a pipe waits for a writer, and
    a device may have no end.
    """
    try:
        found = path.stat()
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        reason = error.strerror or "there is none" if isinstance(error, OSError) else error
        raise UserError(f"{path!s:.300}: cannot be read ({reason}); give an existing file") from None
    if not stat.S_ISREG(found.st_mode):
        kind = "a folder" if stat.S_ISDIR(found.st_mode) else "a pipe, a socket or a device"
        raise UserError(f"{path}: is {kind}, not a file; give an existing file")
    return found.st_size


def read_json(content: bytes) -> Any:
    """Parse a JSON text. Raises ValueError for any other text, and for JSON nested too deeply for the parser."""
    try:
        return json.loads(content)
    except RecursionError:
        raise ValueError("nested too deeply") from None
