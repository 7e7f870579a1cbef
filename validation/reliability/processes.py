"""Commands of rubgen as processes of their own, to be stopped, starved and shut out."""

from __future__ import annotations

import os
import signal
import sys
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

PATIENCE_S = 600.0
"""Whoever takes longer hangs."""
COMMAND = "import os, sys\nfrom rubgen.cli import main\nos.close(int(sys.argv.pop(1)))\nmain()"
"""Its first word is a descriptor. Closing it says that Python has started: no program can handle Ctrl-C before."""


@dataclass
class Process:
    """A command that was started, and the file of its output."""

    pid: int
    log: Path
    code: int | None = None

    def ends_within(self, seconds: float) -> bool:
        """Wait so long for the end; True where it came. Then `code` is the exit code, negative for a signal."""
        deadline = time.monotonic() + seconds
        while self.code is None:
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            if pid:
                self.code = os.waitstatus_to_exitcode(status)
            elif time.monotonic() >= deadline:
                return False
            else:
                time.sleep(0.002)
        return True

    def end(self) -> int:
        """The exit code; a process that hangs is killed and gives -9."""
        if not self.ends_within(PATIENCE_S):
            self.send(signal.SIGKILL)
            self.ends_within(PATIENCE_S)
        return -9 if self.code is None else self.code

    def send(self, number: int) -> None:
        """A signal to the process alone, not to its workers."""
        if self.code is None:
            os.kill(self.pid, number)

    @property
    def output(self) -> str:
        """All it wrote."""
        return self.log.read_text(encoding="utf-8", errors="replace")

    @property
    def lines(self) -> list[str]:
        """Its lines for the user, without warnings."""
        return [line for line in self.output.splitlines() if line.startswith("rubgen: ") and " warning: " not in line]


def start(
    arguments: list[str],
    log: Path,
    *,
    fresh: bool = False,
    wrapper: tuple[str, ...] = (),
    before: Callable[[], None] | None = None,
) -> Process:
    """`rubgen ARGUMENTS` in a new process; `before` runs in it first.

    A `fresh` one is a new interpreter, started by the command `wrapper`, if any. Any other is a fork of this one, with
    rubgen imported and its kernels loaded: the same command line at a tenth of the cost. Either has started rubgen
    when this returns.
    """
    started, starting = os.pipe()
    pid = os.fork()
    if pid:
        os.close(starting)
        with os.fdopen(started, "rb") as end:
            end.read()
        return Process(pid, log)
    code = 1
    try:
        _redirect(log)
        if before is not None:
            before()
        if fresh:
            os.set_inheritable(starting, True)
            command = [*wrapper, sys.executable, "-c", COMMAND, str(starting), *arguments]
            os.execvp(command[0], command)  # noqa: S606 - our own interpreter
        os.close(starting)
        code = _run(arguments)
    except BaseException:  # noqa: BLE001 - the child of a fork must not return
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


def _redirect(log: Path) -> None:
    os.setsid()
    file = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666)
    os.dup2(file, 1)
    os.dup2(file, 2)
    os.close(file)


def _run(arguments: list[str]) -> int:
    from rubgen.cli import main

    try:
        main(arguments)
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else 1
