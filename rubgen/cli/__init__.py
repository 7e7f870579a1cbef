"""The command line: `rubgen generate`, `simulate`, `modes`, `info`, `verify`; imports wait for them."""

from __future__ import annotations

import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NoReturn

__all__ = ["main"]


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run the command line; a Ctrl-C while it is still being imported ends it in one line, as any other does."""
    try:
        from rubgen.cli.interrupts import terminable

        with terminable():
            from rubgen.cli.app import main as run

            run(arguments)
    except KeyboardInterrupt:
        sys.stderr.write("rubgen: interrupted\n")
        raise SystemExit(130) from None
