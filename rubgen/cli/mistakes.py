"""Explain a mistake in a command line in one line: the word, what is allowed, what was perhaps meant."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Literal, get_args, get_origin

from cyclopts import CycloptsError
from cyclopts.exceptions import (
    CoercionError,
    MissingArgumentError,
    RepeatArgumentError,
    UnknownCommandError,
    UnknownOptionError,
    UnusedCliTokensError,
)

if TYPE_CHECKING:
    from cyclopts import App

TYPE_NAMES = {float: "a number", int: "a whole number", bool: "true or false", Path: "a path"}


def mistake(error: CycloptsError, app: App) -> str:
    """Return a message of one line for an error of cyclopts in the command line.

    `app` has the names of the commands.
    """
    command = " ".join(["rubgen", *(error.command_chain or ())])
    see = f"see {command} --help"
    match error:
        case UnknownCommandError():
            word = (error.unused_tokens or [""])[0]
            names = [name for name in app if not name.startswith("-")]
            return f"{word}: unknown command;{meant(word, names)} commands: {', '.join(sorted(names))}"
        case UnknownOptionError():
            word = (error.token.keyword or error.token.value).split("=")[0]
            names = [name for argument in error.argument_collection for name in argument.names]
            return f"{word}: unknown option of {command};{meant(word, names)} {see}"
        case CoercionError() if error.token is not None:
            name = error.token.keyword or (error.argument.name if error.argument else "argument")
            return f"{name} {error.token.value}: {_allowed(error)}; {see}"
        case MissingArgumentError() if error.argument is not None:
            name = error.keyword or error.argument.name
            given = error.keyword is not None or bool(error.argument.tokens)
            return f"{name}: {'a value must follow' if given else f'{command} needs it'}; {see}"
        case RepeatArgumentError() if error.token.keyword:
            return f"{error.token.keyword}: given more than once; give it once"
        case UnusedCliTokensError() if error.unused_tokens:
            return f"{error.unused_tokens[0]}: one argument too many for {command}; {see}"
    return f"{' '.join(str(error).split()).rstrip('.')}; {see}"


def _allowed(error: CoercionError) -> str:
    wanted: object = error.target_type
    if get_origin(wanted) is Literal and error.token is not None:
        choices = [str(choice) for choice in get_args(wanted)]
        return f"must be one of {', '.join(choices)};{meant(error.token.value, choices)}".rstrip(";")
    kinds = [TYPE_NAMES[kind] for kind in (wanted, *get_args(wanted)) if kind in TYPE_NAMES]
    return f"must be {kinds[0] if kinds else 'of another kind'}"


def meant(word: str, known: Iterable[str]) -> str:
    """Return " did you mean ...?" where one of the `known` names is similar to `word`, else an empty text."""
    close = get_close_matches(word, list(known), n=1)
    return f" did you mean {close[0]}?" if close else ""
