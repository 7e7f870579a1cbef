"""The check before every reader: only regular files are read."""

import stat
from pathlib import Path

from rubgen.errors import UserError


def check_regular(path: Path) -> int:
    """Size in bytes of the file at `path`.

    Raises UserError where there is none, or it is a folder, a pipe or a device: opening a pipe waits for a writer, and
    a device may have no end.
    """
    try:
        found = path.stat()
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        reason = error.strerror if isinstance(error, OSError) else error
        raise UserError(f"{path!s:.300}: cannot be read ({reason}); give an existing file") from None
    if not stat.S_ISREG(found.st_mode):
        kind = "a folder" if stat.S_ISDIR(found.st_mode) else "a pipe, a socket or a device"
        raise UserError(f"{path}: is {kind}, not a file; give an existing file")
    return found.st_size
