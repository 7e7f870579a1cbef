"""Print results for people and programs, and write the files that a command was asked for."""

import json
import math
import sys
from collections.abc import Callable
from pathlib import Path

from rubgen.errors import UserError, write_problems

REPORT = "report.html"
"""The name of the page of a data set, which lies in it."""


def say(text: str) -> None:
    """Print `text` and a line end on stdout, with control characters and line breaks escaped."""
    sys.stdout.write(f"{printable(text)}\n")


def printable(text: str) -> str:
    """Return the text with control characters and line breaks as escapes: a terminal would obey them."""
    return "".join(each if each.isprintable() else each.encode("unicode_escape").decode() for each in text)


def print_json(values: dict[str, object]) -> None:
    """Print one JSON document on stdout. NaN and infinity become null."""
    sys.stdout.write(f"{json.dumps(_plain(values), indent=2, allow_nan=False)}\n")


def print_pairs(values: dict[str, object]) -> None:
    """Print names and values in two columns: yes or no for flags, 6 digits for floats, - for None."""
    width = max(map(len, values), default=0)
    for name, value in values.items():
        say(f"{name:<{width}}  {_text(value)}")


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if value is None:
        return "-"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list):
        return "  ".join(_text(each) for each in value) or "-"
    if isinstance(value, dict):
        return "  ".join(f"{name} {_text(each)}" for name, each in value.items()) or "-"
    return str(value)


def _plain(value: object) -> object:
    if isinstance(value, dict):
        return {str(name): _plain(each) for name, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def check_new_file(option: str, path: Path, endings: tuple[str, ...], *, force: bool = False) -> None:
    """Check, before any work, that a command can write the file at `path` that the user named with `option`.

    - endings: allowed endings of the name, such as ".png".
    - force: whether an existing file may be replaced (the option --force).

    Raises UserError where the ending is not allowed, the folder does not exist, the file would lie in a data set,
    `path` is no file, or the file exists and `force` is False. Only the report may lie in a data set: `rubgen verify`
    would find a file that the manifest does not list. Nothing is written.
    """
    from rubgen.io.places import set_around

    if path.suffix not in endings:
        allowed = endings[0] if len(endings) == 1 else f"{', '.join(endings[:-1])} or {endings[-1]}"
        raise UserError(f"{option} {path}: unknown kind of file; end the name in {allowed}")
    if not path.parent.is_dir():
        raise UserError(f"{option} {path}: there is no directory {path.parent}; make it first")
    data_set = set_around(path)
    if data_set and path.name != REPORT:
        raise UserError(f"{option} {path}: lies in the data set {data_set}; choose a place outside of it")
    if path.exists() and not path.is_file():
        raise UserError(f"{option} {path}: exists already and is no file; choose another name")
    if path.exists() and not force:
        raise UserError(f"{option} {path}: exists already; choose another name, or replace it with --force")


def write_file(option: str, path: Path, write: Callable[[Path], object]) -> None:
    """Call `write` with a temporary path, then rename the file to `path`: an old file stays whole until then.

    `option` names the file in messages. Raises UserError where it cannot be written.
    """
    from rubgen.io.files import write_durably

    with write_problems(path, named=f"{option} {path}"):
        write_durably(path, write)
