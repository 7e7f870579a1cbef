"""What every command that keeps its results does in the same way: it shows how far it is and ends in one line."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from rubgen.cli.interrupts import terminable
from rubgen.errors import UserError
from rubgen.progress import shown, step

MISTAKE, INTERRUPTED = 2, 130


def run_command(name: str, root: Path, work: Callable[[], None], *, show: bool = True) -> int:
    """Exit code of `work`, whose store is at `root`: 0, 2 after a mistake of the user, 130 after Ctrl-C."""
    try:
        with terminable(), shown(show), step("simulate", "pieces"):
            work()
    except UserError as error:
        sys.stderr.write(f"{name}: {error}\n")
        return MISTAKE
    except KeyboardInterrupt:
        sys.stderr.write(f"{name}: interrupted; finished pieces are kept in {root}: the same command makes the rest\n")
        return INTERRUPTED
    return 0
