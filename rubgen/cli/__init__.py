"""The command line: `rubgen generate`, `simulate`, `modes`, `reproduce`, `info`, `verify`; imports wait for them."""

from rubgen.cli.app import main

__all__ = ["main"]
