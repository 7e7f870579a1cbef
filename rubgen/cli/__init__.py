"""The command line `rubgen`. A command imports its work when it is called."""

from __future__ import annotations

import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NoReturn

__all__ = ["main"]
STDERR = 2


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run the command line with the words `arguments` and exit. None stands for the words after the program's name.

    Ctrl-C ends the program with one line and the exit code 130.
    """
    try:
        _open_streams()
        from rubgen.cli.interrupts import terminable

        with terminable():
            from rubgen.cli.run import main as run

            run(arguments)
    except KeyboardInterrupt:
        sys.stderr.write("rubgen: interrupted\n")
        raise SystemExit(130) from None


def _open_streams() -> None:
    """Give closed standard streams (`>&-`) the null device, else a file of the set gets their number and their text."""
    import os  # there since Python's own start

    number = os.open(os.devnull, os.O_RDWR)
    while number <= STDERR:
        number = os.open(os.devnull, os.O_RDWR)
    os.close(number)
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(os.open(os.devnull, os.O_WRONLY), "w"))
