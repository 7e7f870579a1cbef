"""Cases in a process of their own, each within bounds of CPU time and memory; whatever kills it is an outcome."""

from __future__ import annotations

import gc
import os
import resource
import select
import signal
import sys
import time
import traceback
import warnings
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TextIO

from rubgen.errors import UserError

SECONDS = 5.0
"""CPU time of one case."""
TOO_LONG = "more than {:g} s"
MEMORY = 2 * 1024**3
"""Bytes that one case may take beside what is loaded."""
PATIENCE_S = 120.0
"""A case that neither ends nor computes for so long hangs."""
GOOD = ("right", "one line")
_PAGE = os.sysconf("SC_PAGE_SIZE")


def outcomes(work: Callable[[int], str], cases: Sequence[int], *, memory: int = MEMORY) -> Iterator[tuple[int, str]]:
    """Each case with what `work` says of it, `one line` for a UserError, or how it failed."""
    remaining = list(cases)
    while remaining:
        yield from _some_outcomes(work, remaining, memory)


def _some_outcomes(work: Callable[[int], str], remaining: list[int], memory: int) -> Iterator[tuple[int, str]]:
    """Those of one process, until it dies or all is done; what is done leaves `remaining`."""
    source, sink = os.pipe()
    pid = os.fork()
    if not pid:
        os.close(source)
        _child(work, remaining, sink, memory)
    os.close(sink)
    with os.fdopen(source, encoding="utf-8") as lines:
        while remaining and (line := _next_line(lines, pid)):
            yield remaining.pop(0), line.rstrip("\n")
    _, status = os.waitpid(pid, 0)
    if remaining:
        code = os.waitstatus_to_exitcode(status)
        known = {-signal.SIGPROF: TOO_LONG.format(SECONDS), -signal.SIGKILL: f"hung for {PATIENCE_S:g} s"}
        yield remaining.pop(0), known.get(code, f"died with {code}")


def _next_line(lines: TextIO, pid: int) -> str:
    if not select.select([lines], [], [], PATIENCE_S)[0]:
        os.kill(pid, signal.SIGKILL)
    return lines.readline()


def _child(work: Callable[[int], str], cases: Sequence[int], sink: int, memory: int) -> None:
    code = 1
    try:
        quiet = os.open(os.devnull, os.O_RDWR)
        os.dup2(quiet, 1)
        warnings.simplefilter("ignore")
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        gc.freeze()
        for case in cases:
            _limit(memory)
            begun = time.process_time()
            outcome = one_outcome(work, case)
            if time.process_time() - begun > SECONDS:
                outcome = TOO_LONG.format(SECONDS)
            os.write(sink, f"{outcome}\n".encode(errors="replace"))
        code = 0
    except BaseException:  # noqa: BLE001 - the child of a fork must not return
        traceback.print_exc(file=sys.stderr)
    finally:
        os._exit(code)


def one_outcome(work: Callable[[int], str], case: int) -> str:
    """What `work` says of a case, or how it fails, in one line."""
    try:
        return work(case)
    except UserError as error:
        return "one line" if "\n" not in str(error) and len(str(error)) < 3000 else f"long message: {str(error)!r:.90}"
    except Exception as error:  # noqa: BLE001 - everything else is what is looked for
        frames = traceback.extract_tb(error.__traceback__)
        place = next((frame for frame in reversed(frames) if "/rubgen/" in frame.filename), frames[-1])
        where = f"{Path(place.filename).name}:{place.lineno}"
        return " ".join(f"{type(error).__name__} in {where}: {error!s:.150}".split())


def _limit(memory: int) -> None:
    """Let the next case have so much CPU time, of all threads, and memory.

    The system counts the CPU time that ends a process in ticks: over thousands of cases it goes seconds away from what
    `process_time` says. A limit for the whole process, RLIMIT_CPU, then ended a case of 0.03 s.
    """
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    resource.setrlimit(resource.RLIMIT_AS, (pages * _PAGE + memory, resource.RLIM_INFINITY))
