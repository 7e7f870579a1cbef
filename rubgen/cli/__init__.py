"""The command line: `rubgen generate`, `simulate`, `modes`, `info`, `verify`. Heavy imports wait for the command."""

from rubgen.cli.app import main

__all__ = ["main"]
