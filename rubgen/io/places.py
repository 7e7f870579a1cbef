"""Where a data set is: a directory, or a URL such as s3://bucket/set, which fsspec reads and writes."""

from __future__ import annotations

import os
import re
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar, cast

from rubgen.errors import RubgenError, UserError

R = TypeVar("R")
S3 = ("s3", "s3a")
PATIENCE_S = 30.0
"""Time in which a server must answer first."""
_URL = re.compile(r"([A-Za-z][A-Za-z0-9+.-]+)://(.*)", re.DOTALL)
"""A scheme of two letters at least: C:// is a disk of Windows."""


def is_url(place: object) -> bool:
    """Return whether a text, or a path from `place_of`, is a URL."""
    return bool(_URL.match(place)) if isinstance(place, str) else hasattr(place, "fs")


def place_of(text: str | Path) -> Path:
    """Return the path of a directory, or of a URL as a UPath, which has the methods of a Path that reading needs.

    Keys, endpoints and regions come from the settings of the library for the URL's scheme: environment, files of
    settings, configuration of fsspec. A URL of the local file system gives a Path. The place need not exist. Raises
    UserError where the scheme is unknown, its library is not installed, nothing follows it, or the URL contains a name
    or a password. Raises TypeError for what is neither a text nor a path.
    """
    found = _URL.match(text) if isinstance(text, str) else None
    if not isinstance(text, str) or not found:
        return text if is_url(text) else Path(text)  # type: ignore[return-value]
    scheme, rest = found.groups()
    if "@" in rest.partition("/")[0]:
        raise UserError(f"{scheme}://...: holds a name or a password; give them in the library's own way, not in a URL")
    if not rest.strip("/"):
        raise UserError(f"{text}: names no place in it; give a URL such as s3://bucket/set")
    try:
        from upath import UPath

        path = UPath(text.rstrip("/"))
        known: Any = path.fs  # imports the library of the scheme
    except ImportError as error:
        how = "pip install 'rubgen[remote]'" if error.name == "upath" or scheme in S3 else _reason(error)
        raise UserError(f"{text}: its library is missing; install it: {how}") from None
    except ValueError as error:
        raise UserError(f"{text}: cannot be used ({_reason(error)}); give a URL such as s3://bucket/set") from None
    return Path(path.path) if "file" in known.protocol else cast("Path", path)


def check_local(path: Path, what: str) -> None:
    """Raise UserError where `path` is a URL. `what` needs a directory, for the message."""
    if is_url(path):
        raise UserError(f"{path}: {what} needs a directory; bring the files there first")


def set_around(path: Path) -> Path | None:
    """Return the innermost folder above `path` that holds a finished data set, or None."""
    for folder in Path(os.path.realpath(path)).parents:
        if all((folder / name).is_file() for name in ("manifest.json", "manifest.json.sha256")):
            return folder
    return None


def is_there(path: Path) -> bool:
    """Return whether the file at `path` exists.

    For a URL raises UserError where the server does not answer or refuses.
    """
    if not is_url(path):
        return path.exists()
    files: Any = path

    def look() -> bool:
        try:
            files.fs.invalidate_cache()
            files.fs.info(files.path)
        except FileNotFoundError:
            return False
        return True

    return answered(path, look)


def answered(path: Path, work: Callable[[], R]) -> R:
    """Call `work`, a short request to the server of the URL `path`, and return its result.

    Raises UserError where the server does not answer within PATIENCE_S, and where `work` raises any error
    (`url_problems`). Without this bound the libraries try again for many minutes. After it `work` may go on in its
    thread.
    """
    results: list[R] = []
    errors: list[BaseException] = []

    def run() -> None:
        try:
            results.append(work())
        except BaseException as error:  # noqa: BLE001 -- it is raised below, in the thread that waits
            errors.append(error)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    thread.join(PATIENCE_S)
    if thread.is_alive():
        raise UserError(f"{path}: its server does not answer within {PATIENCE_S:g} s; check address and network")
    with url_problems(path):
        if errors:
            raise errors[0]
    return results[0]


@contextmanager
def url_problems(path: Path) -> Iterator[None]:
    """Turn an Exception of the block, which uses the URL `path`, into a UserError of one line that names `path`.

    Each library has errors of its own, so all are turned in the same way. A RubgenError passes unchanged. It is not
    checked that `path` is a URL.
    """
    try:
        yield
    except RubgenError:
        raise
    except Exception as error:  # noqa: BLE001 -- there is no common base
        raise UserError(
            f"{path}: cannot be used ({_reason(error)}); give a place that exists and that you may use"
        ) from None


def _reason(error: Exception) -> str:
    return " ".join(str(error).split())[:150].rstrip(".") or type(error).__name__
