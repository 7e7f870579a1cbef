"""What the system refuses, in one line that says no more than is known."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rubgen.errors import RubgenError, UserError

_FULL = {errno.ENOSPC: "the disk is full", errno.EDQUOT: "the disk quota is used up"}


@contextmanager
def problems_told(root: Path) -> Iterator[None]:
    """Raise a UserError for an OSError of the output directory `root`, a RubgenError with its own cause for another."""
    try:
        yield
    except BrokenPipeError:  # whoever read our output has gone
        raise
    except OSError as error:
        reason = error.strerror or str(error)
        path = os.fsdecode(error.filename) if isinstance(error.filename, str | bytes | os.PathLike) else None
        full = _FULL.get(error.errno or 0)
        if not (full if path is None else _is_of(path, root)):
            where = "" if path is None else f"{path}: "
            raise RubgenError(f"{where}{reason}; finished runs are kept: the same command makes the rest") from error
        if full:
            raise UserError(
                f"{root}: {full}; make room and give the same command again: finished runs are kept"
            ) from None
        raise UserError(f"{path}: cannot be written ({reason}); give a directory that you may write to") from None


def _is_of(path: str, root: Path) -> bool:
    """Whether the path is `root`, lies below it, or is a directory that it would lie in."""
    own, output = Path(os.path.realpath(path)), Path(os.path.realpath(root))
    return own.is_relative_to(output) or output.is_relative_to(own)
