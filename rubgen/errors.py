"""Errors and warnings for the user."""

import errno
import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_FULL = {errno.ENOSPC: "the disk is full", errno.EDQUOT: "the disk quota is used up"}


class RubgenError(Exception):
    """Base of every error that rubgen raises on purpose."""


class UserError(RubgenError):
    """A mistake in the user's input. Its message is one line: where, what, what is allowed and the remedy.

    The command line prints only the message and exits with 2.
    """


class NoPictureError(UserError, ValueError):
    """A run, a set or a choice that a picture cannot show. It is a ValueError too, as of any wrong argument."""


class RubgenWarning(UserWarning):
    """A value that is allowed but hardly intended, or work that is not done as requested. The work continues.

    The command line prints only the message on stderr, in one line.
    """


def warn(message: str) -> None:
    """Show the user a warning of one line, as a RubgenWarning."""
    warnings.warn(message, RubgenWarning, stacklevel=2)


@contextmanager
def write_problems(
    output: Path, *, named: str = "", advice: str = "choose another place", kept: str = ""
) -> Iterator[None]:
    """Turn errors of a block that writes `output` into errors that name the file.

    An OSError at `output`, below it or at a folder above it, and a full disk where the system names no file, become a
    UserError, since the user can mend them. Any other OSError, also a full disk at another file, becomes a RubgenError
    with the file that the system names. A closed pipe (BrokenPipeError) is raised unchanged.

    - `output`: file or directory that the block writes
    - `named`: its name in messages; the path if empty
    - `advice`: what the user can do if it cannot be written, except on a full disk
    - `kept`: what is not lost, for the messages of a full disk and of an error elsewhere
    """
    try:
        yield
    except BrokenPipeError:  # the reader of our output has closed it
        raise
    except OSError as error:
        path = os.fsdecode(error.filename) if isinstance(error.filename, str | bytes | os.PathLike) else None
        full = _FULL.get(error.errno or 0)
        if not (full if path is None else _is_at(path, output)):
            rest = f"; {kept}: the same command makes the rest" if kept else ""
            raise RubgenError(os_reason(error) + rest) from error
        if full:
            rest = f": {kept}" if kept else ""
            raise UserError(f"{named or output}: {full}; make room and give the same command again{rest}") from None
        raise UserError(f"{named or path}: cannot be written ({_text_of(error)}); {advice}") from None


def os_reason(error: OSError) -> str:
    """Return the system's reason for an OSError, after the name of the file if the error has one."""
    named = isinstance(error.filename, str | bytes | os.PathLike)
    return f"{os.fsdecode(error.filename)}: {_text_of(error)}" if named else _text_of(error)


def _text_of(error: OSError) -> str:
    """Return the system's text for the error number. pyarrow and others add text of their own to `strerror`."""
    return os.strerror(error.errno) if error.errno else " ".join((error.strerror or str(error)).split())


def _is_at(path: str, output: Path) -> bool:
    """Whether the path is `output`, lies below it, or is a directory that it would lie in."""
    own, root = Path(os.path.realpath(path)), Path(os.path.realpath(output))
    return own.is_relative_to(root) or root.is_relative_to(own)
