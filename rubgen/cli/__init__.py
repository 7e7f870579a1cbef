"""The command line: `rubgen generate`, `simulate`, `modes`, `info`, `verify`; imports wait for them."""

from typing import NoReturn

__all__ = ["main"]


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run the command line; a Ctrl-C while it is still being imported ends it as quietly as any other."""
    try:
        from rubgen.cli.app import main as run
    except KeyboardInterrupt:
        raise SystemExit(130) from None
    run(arguments)
