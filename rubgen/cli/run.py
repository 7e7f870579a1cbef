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

DONE, WANTING, MISTAKE, INTERRUPTED = 0, 1, 2, 130
"""Exit codes. WANTING: the command ran and found something wrong. MISTAKE: the user's input is wrong."""


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run the command line with `arguments`, by default those of the process, and exit. It never returns.

    Any error becomes one line on stderr and an exit code: 1 for a RubgenError, 2 for the user's mistake, 130 for
    Ctrl-C.
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
        with shown("--json" not in words):
            code = app(words, exit_on_error=False, print_error=False, result_action="return_value")
        sys.stdout.flush()
        sys.exit(DONE if code is None else code)
    except CycloptsError as error:
        _fail(mistake(error, app), MISTAKE)
    except UserError as error:
        _fail(str(error), MISTAKE)
    except RubgenError as error:
        _fail(str(error), WANTING)
    except KeyboardInterrupt:
        _fail("interrupted", INTERRUPTED)
    except BrokenPipeError:
        # The reader of our output has closed it. Python must not flush to it at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(WANTING)
    except UnicodeEncodeError as error:
        _fail(f"{str(error.object)[:200]!r}: cannot be encoded as {error.encoding} ({error.reason})", MISTAKE)
    except OSError as error:
        _fail(os_reason(error), MISTAKE)


def _show_warning(message: Warning | str, category: type[Warning], *_where: Any, **_how: Any) -> None:
    """Write a warning in one line, without its place in the code, which is of no use to a user."""
    name = "warning" if issubclass(category, RubgenWarning) else category.__name__
    sys.stderr.write(f"rubgen: {name}: {_one_line(message)}\n")


def _one_line(error: Exception | str) -> str:
    return printable(" ".join(str(error).split())).rstrip(".")


def _fail(message: str, code: int) -> NoReturn:
    sys.stderr.write(f"rubgen: {printable(message)}\n")
    sys.exit(code)
