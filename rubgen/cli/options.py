"""Types of parameters that several commands share, and how their words are read."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter, Token

from rubgen.errors import UserError


def option(text: str) -> Parameter:
    """Return the declaration of an option or argument with the help text `text`."""
    return Parameter(help=text)


def whole_number(text: str) -> Parameter:
    """Return the declaration of an option that takes a whole number, with the help text `text`."""
    return Parameter(help=text, converter=whole)


def whole(_type: Any, tokens: Sequence[Token]) -> int:
    """Return the integer in the text of an option. Without this converter cyclopts would truncate 2.5 to 2.

    Raises ValueError for any other text.
    """
    return int(tokens[0].value)


def place(text: str) -> Parameter:
    """Return the declaration of an option that takes a path or URL, with the help text `text`."""
    return Parameter(help=text, converter=_as_written)


def here(text: str) -> Parameter:
    """Return the declaration of an option or argument that takes a path on this computer, with the help text `text`."""
    return Parameter(help=text, converter=_here)


def _here(_type: Any, tokens: Sequence[Token]) -> Path:
    """Return a path. Raises UserError for a URL: its slashes would become a folder called s3: in the current one."""
    text = tokens[0].value
    if "://" in text:
        named = f"{tokens[0].keyword} {text}" if tokens[0].keyword else text
        raise UserError(f"{named}: is a URL; give a path on this computer")
    return Path(text)


def _local(_type: Any, tokens: Sequence[Token]) -> Path:
    text = tokens[0].value
    if "://" in text:
        raise UserError(f"{text}: this command needs a directory; bring the files there first")
    return Path(text)


def _as_written(_type: Any, tokens: Sequence[Token]) -> Path | str:
    """Return a URL as it was written: a Path would make one slash of two."""
    text = tokens[0].value
    return text if "://" in text else Path(text)


def names_in(option: str, text: str | None) -> list[str] | None:
    """Return the names in `text`, which has commas between them; None for None.

    Raises UserError, which names the option `option`, where a name is empty.
    """
    if text is None:
        return None
    names = [name.strip() for name in text.split(",")]
    if not all(names):
        raise UserError(f"{option} {text!r:.60}: has an empty name; give names with commas between them")
    return names


Json = Annotated[bool, Parameter(name="--json", negative=(), help="Print JSON, for programs.")]
MachineName = Annotated[str, option("Name of a preset, or path of a machine TOML.")]
RecipeFile = Annotated[
    Path | None, option("Recipe TOML, or a name of rubgen list; without it zeng2019-mini of 32 runs.")
]
Force = Annotated[bool, Parameter(negative=(), help="Replace a file that is there.")]
Directory = Annotated[Path, Parameter(help="Directory of a data set.", converter=_local)]
Place = Annotated[Path, place("Directory of a data set, or its URL such as s3://bucket/set.")]
