"""Errors that are addressed to the user."""

from __future__ import annotations

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
    """A mistake in what the user gave: one line that says where, what, what is allowed and how to mend it.

    The command line prints the message alone and exits with 2.
    """


class RubgenWarning(UserWarning):
    """What is allowed but surely not meant, or was done in another way than asked: one line, and the work goes on.

    The command line prints the message alone on stderr.
    """


def warn(message: str) -> None:
    """Warn the user in one line, whatever called this."""
    warnings.warn(message, RubgenWarning, stacklevel=2)


@contextmanager
def write_problems(
    output: Path, *, named: str = "", advice: str = "choose another place", kept: str = ""
) -> Iterator[None]:
    """Raise a UserError for an OSError at `output`, a RubgenError with its own cause and file for any other.

    `output` is the file or directory that is written, `named` what a message calls it (the path where it is empty).
    `advice` says what to do where it cannot be written, `kept` what is not lost.
    """
    try:
        yield
    except BrokenPipeError:  # whoever read our output has gone
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
    """What the system refused, and at which file where it says so."""
    named = isinstance(error.filename, str | bytes | os.PathLike)
    return f"{os.fsdecode(error.filename)}: {_text_of(error)}" if named else _text_of(error)


def _text_of(error: OSError) -> str:
    """The system's words for the error; pyarrow and others put theirs around them."""
    return os.strerror(error.errno) if error.errno else " ".join((error.strerror or str(error)).split())


def _is_at(path: str, output: Path) -> bool:
    """Whether the path is `output`, lies below it, or is a directory that it would lie in."""
    own, root = Path(os.path.realpath(path)), Path(os.path.realpath(output))
    return own.is_relative_to(root) or root.is_relative_to(own)
