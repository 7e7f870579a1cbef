"""The command line `rubgen`. A command imports its work when it is called."""

from __future__ import annotations

import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NoReturn

__all__ = ["main"]


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run the command line. A Ctrl-C during the imports also ends it in one line."""
    try:
        from rubgen.cli.interrupts import terminable

        with terminable():
            from rubgen.cli.run import main as run

            run(arguments)
    except KeyboardInterrupt:
        sys.stderr.write("rubgen: interrupted\n")
        raise SystemExit(130) from None
