"""The end of the process, or an error of the disk, at each single operation that changes the output directory."""

from __future__ import annotations

import errno
import json
import os
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import NoReturn

import numpy as np

from validation.reliability.rows import Row, timed
from validation.reliability.sets import Truth

WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT
CHANGES = ("os.rename", "os.remove", "os.rmdir", "os.mkdir", "os.link", "os.symlink", "os.truncate")
ERRORS = (errno.ENOSPC, errno.EDQUOT, errno.EIO)


def stop_row(truth: Truth, most: int) -> Row:
    """The process ends just before operation k, for each k or `most` of them; then the same command completes."""
    row = Row("the process ends at one operation on the disk")
    with timed(row):
        for k in _chosen(_count(truth), most):
            row.tries += 1
            out = truth.new_directory()
            process = truth.generate(out, before=partial(_watch, out, k, lambda: os._exit(9)))
            if process.end() not in (0, 9) or "Traceback" in process.output:
                row.fail("tracebacks", f"operation {k}: {process.output.strip()[-300:]}")
            truth.complete(out, row, f"operation {k}")
    return row


def error_row(truth: Truth, most: int) -> Row:
    """Operation k fails once with a full disk, a quota or a hardware error: one line, then the same bytes."""
    row = Row("one operation on the disk fails")
    with timed(row):
        for k in _chosen(_count(truth), most):
            row.tries += 1
            out, number = truth.new_directory(), ERRORS[k % len(ERRORS)]
            what = f"operation {k} gives {errno.errorcode[number]}"
            process = truth.generate(out, before=partial(_watch, out, k, partial(_fail, number, out)))
            code = process.end()
            if "Traceback" in process.output or code not in (0, 2) or (code == 2 and len(process.lines) != 1):
                row.fail("tracebacks", f"{what}: {code}: {process.output.strip()[-300:]}")
            truth.complete(out, row, what)
    return row


def _fail(number: int, out: Path) -> None:
    raise OSError(number, os.strerror(number), str(out / "file"))


def _chosen(count: int, most: int) -> list[int]:
    """All operations, or for one half the first, where the directory is claimed, and others evenly spread."""
    if count <= most:
        return list(range(1, count + 1))
    first = most // 2
    return [*range(1, first + 1), *np.linspace(first + 1, count, most - first).round().astype(int).tolist()]


def _count(truth: Truth) -> int:
    """How many operations an undisturbed making has."""
    out = truth.new_directory()
    counted = truth.folder / "operations.json"

    def before() -> None:
        operations = _watch(out, 0, lambda: None)
        leave = os._exit

        def told(status: int) -> NoReturn:
            counted.write_text(json.dumps(operations))
            leave(status)

        os._exit = told

    truth.generate(out, before=before).end()
    return len(json.loads(counted.read_text(encoding="utf-8")))


def _watch(out: Path, k: int, act: Callable[[], None]) -> list[str]:
    """Call `act` before operation `k` below `out` or on itself; gives the list to which operations are added."""
    operations: list[str] = []
    root = os.fspath(out)

    def note(name: str) -> None:
        operations.append(name)
        if len(operations) == k:
            act()

    def hook(event: str, arguments: tuple[object, ...]) -> None:
        if event in CHANGES or (event == "open" and _writes(arguments)):
            path = arguments[0]
            if isinstance(path, str | os.PathLike) and os.fspath(path).startswith(root):
                note(f"{event} {path}")

    sys.addaudithook(hook)
    sync = os.fsync

    def watched_sync(descriptor: int) -> None:
        note("fsync")
        sync(descriptor)

    os.fsync = watched_sync  # type: ignore[assignment]
    return operations


def _writes(arguments: tuple[object, ...]) -> bool:
    flags = arguments[2]
    return isinstance(flags, int) and bool(flags & WRITING)
