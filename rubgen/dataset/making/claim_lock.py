"""A lock between processes, on any file system."""

import errno
from pathlib import Path

from filelock import BaseFileLock, FileLock, SoftFileLock, Timeout

from rubgen.errors import warn

_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EINVAL)
"""What file systems answer that have no locks, as NFS without its lock daemon."""


def acquired(path: Path) -> BaseFileLock | None:
    """The lock at `path`, or None where another process has it.

    Where the file system has no locks, a file that only one process can make is the lock, and a remark says so.
    """
    try:
        return _acquired(FileLock(path, timeout=0))
    except NotImplementedError as error:
        reason: object = error
    except OSError as error:
        if error.errno not in _NO_LOCKS:
            raise
        reason = error.strerror
    soft = soft_lock(path)
    warn(f"{path.parent}: no file locks there ({reason}); {soft.name} is made instead, delete it after a kill")
    return _acquired(SoftFileLock(soft, timeout=0))


def soft_lock(path: Path) -> Path:
    """The file that stands for the lock at `path` where there are no locks."""
    return path.with_name(f"{path.name}.soft")


def _acquired(lock: BaseFileLock) -> BaseFileLock | None:
    try:
        lock.acquire()
    except Timeout:
        return None
    return lock
