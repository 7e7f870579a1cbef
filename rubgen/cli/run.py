"""Run the command line and end the process with its exit code. Every failure is one line on stderr."""

import io
import os
import sys
import warnings
from typing import Any, NoReturn

from cyclopts import CycloptsError

from rubgen.cli.app import app
from rubgen.cli.mistakes import mistake
from rubgen.cli.printing import printable
from rubgen.errors import RubgenError, RubgenWarning, UserError, os_reason
from rubgen.progress import shown

DONE, WANTING, MISTAKE, INTERRUPTED, UNREAD = 0, 1, 2, 130, 141
EXIT_CODES = {
    DONE: "the command did what it was asked",
    WANTING: "the command ran and found something wrong, such as a damaged set, or worker processes died",
    MISTAKE: "the input is wrong, or a file or the disk cannot be used: one line on stderr says why",
    INTERRUPTED: "Ctrl-C or SIGTERM",
    UNREAD: "the program that read the output has closed the pipe, as `head` does",
}
"""Meaning of each. Shells show the last two, 128 and the number of a signal, also where that signal ends a program."""


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run the command line with the words `arguments` and exit. It never returns.

    None stands for the words after the program's name. The exit code is that of the command, unless there is an error.
    An error becomes one line on stderr and one of EXIT_CODES: 2 for a mistake of the user (UserError) or an OSError, 1
    for any other RubgenError, 130 for Ctrl-C. Any other exception is a bug and passes with its traceback. If the reader
    of the output has closed the pipe, nothing is printed and the exit code is 141.
    """
    warnings.simplefilter("always", RubgenWarning)
    warnings.showwarning = _show_warning
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(
                errors="backslashreplace"
            )  # a name that this terminal cannot show must not fail the command
    words = sys.argv[1:] if arguments is None else arguments
    try:
        code = _code_of(words)
    except (BrokenPipeError, SystemExit) as error:
        if isinstance(error, SystemExit) and not isinstance(error.__context__, BrokenPipeError):
            raise
        # rich, which prints the help, makes a SystemExit of it. Python must not flush to the closed pipe at exit.
        for stream in (sys.stdout, sys.stderr):
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
        code = UNREAD
    sys.exit(code)


def _code_of(words: list[str]) -> int:
    """Run the command line and return its exit code. An error is printed on stderr."""
    try:
        with shown("--json" not in words):
            code = app(words, exit_on_error=False, print_error=False, result_action="return_value")
        sys.stdout.flush()
        return DONE if code is None else int(code)
    except CycloptsError as error:
        return _failed(mistake(error, app), MISTAKE)
    except UserError as error:
        return _failed(str(error), MISTAKE)
    except RubgenError as error:
        return _failed(str(error), WANTING)
    except KeyboardInterrupt:
        return _failed("interrupted", INTERRUPTED)
    except BrokenPipeError:
        raise
    except UnicodeEncodeError as error:
        return _failed(f"{str(error.object)[:200]!r}: cannot be encoded as {error.encoding} ({error.reason})", MISTAKE)
    except OSError as error:
        return _failed(os_reason(error), MISTAKE)


def _show_warning(message: Warning | str, category: type[Warning], *_where: Any, **_how: Any) -> None:
    """Write a warning in one line, without its place in the code, which is of no use to a user."""
    name = "warning" if issubclass(category, RubgenWarning) else category.__name__
    sys.stderr.write(f"rubgen: {name}: {_one_line(message)}\n")


def _one_line(error: Exception | str) -> str:
    return printable(" ".join(str(error).split())).rstrip(".")


def _failed(message: str, code: int) -> int:
    sys.stderr.write(f"rubgen: {printable(message)}\n")
    return code
