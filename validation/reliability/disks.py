"""Disks that are full or read-only, folders that may not be written, no home."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from validation.reliability.processes import Process, start
from validation.reliability.rows import Row, timed
from validation.reliability.sets import Truth

NOBODY = 65534
CAPABILITY = "=-all,+dac_read_search"
AS_NOBODY = (
    "setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups",
    f"--inh-caps{CAPABILITY}", f"--ambient-caps{CAPABILITY}",
    "env", "-u", "RUBGEN_CACHE_DIR", "-u", "XDG_CACHE_HOME", "HOME=/nonexistent",
)  # fmt: skip
"""A user who may read all, where the interpreter may stand in a home that is closed, and write to nothing but /tmp."""
NO_ROOT = "needs the rights of root, to mount a small disk and to become another user"
ENOUGH = "64m"


def full_disk_row(truth: Truth, tries: int) -> Row:
    """A disk too small for the set, of many sizes; with more room the same command completes it."""
    row = Row("full disk", skipped="" if _may_mount(truth.folder) else NO_ROOT)
    if row.skipped:
        return row
    needed = sum(path.stat().st_size for path in truth.directory.rglob("*") if path.is_file())
    with timed(row):
        for kilobytes in np.geomspace(4, 2.2 * needed / 1024, tries).astype(int).tolist():
            row.tries += 1
            with _disk(truth.folder / "disk", f"{kilobytes}k") as disk:
                what = f"a disk of {kilobytes} kB"
                process = truth.generate(disk / "set")
                if process.end() != 0:
                    _check_refusal(process, row, what, "the disk is full")
                _remount(disk, f"size={ENOUGH}")
                truth.complete(disk / "set", row, what)
    return row


def read_only_row(truth: Truth, tries: int) -> Row:
    """A disk that is read-only before the first file, or becomes so after a stop; writable again, it is completed."""
    row = Row("read-only disk", skipped="" if _may_mount(truth.folder) else NO_ROOT)
    if row.skipped:
        return row
    with timed(row):
        for share in np.linspace(0, 1, tries).tolist():
            row.tries += 1
            with _disk(truth.folder / "disk", ENOUGH) as disk:
                what = f"read-only after {share:.2f} of a generation"
                if share:
                    _interrupted(truth, disk / "set", share)
                _remount(disk, "ro")
                process = truth.generate(disk / "set")
                if process.end() != 0:
                    _check_refusal(process, row, what, "")
                _remount(disk, "rw")
                truth.complete(disk / "set", row, what)
    return row


def shut_out_row(truth: Truth, *, whole: bool) -> Row:
    """As a user without rights, home and cache: what only reads works, what may not be written is refused in one line.

    The `whole` of it also compiles kernels, without a place to keep them, and makes a set, a page and a replay.
    """
    row = Row("no rights, no home, no cache", skipped="" if os.geteuid() == 0 and shutil.which("setpriv") else NO_ROOT)
    if row.skipped:
        return row
    mine, there = truth.folder / "mine", str(truth.directory)
    mine.mkdir()
    shutil.chown(mine, NOBODY, NOBODY)
    reading = [["info", there], ["verify", there]]
    refused = [["generate", str(truth.recipe), "--out", str(truth.folder / "refused"), "--json"]]
    if whole:
        replay = ["replay", there, "run-000001", "--save"]
        making = ["generate", str(truth.recipe), "--out", str(mine / "set"), "--workers", "1", "--json"]
        reading += [
            ["label", there],
            ["report", there, "--out", str(mine / "page.html")],
            [*replay, str(mine / "a.rrd")],
        ]
        reading += [making]
        refused += [[*replay, str(truth.folder / "a.rrd")], ["report", there, "--out", str(truth.folder / "page.html")]]
    with timed(row):
        for arguments in [*reading, *refused]:
            row.tries += 1
            process = start(arguments, truth.folder / "nobody.log", fresh=True, wrapper=AS_NOBODY)
            process.end()
            if arguments in refused:
                _check_refusal(process, row, f"as nobody: {arguments[0]}", "")
            elif process.code != 0:
                row.fail("tracebacks", f"as nobody: {arguments[0]}: {process.code}: {process.output.strip()[-400:]}")
        if whole:
            truth.complete(mine / "set", row, "made as nobody")
    return row


def _check_refusal(process: Process, row: Row, what: str, said: str) -> None:
    one_line = len(process.lines) == 1 and said in process.output
    if process.code != 2 or not one_line or "Traceback" in process.output:
        row.fail("tracebacks", f"{what}: {process.code}: {process.output.strip()[-400:]}")


def _interrupted(truth: Truth, out: Path, share: float) -> None:
    process = truth.generate(out)
    if not process.ends_within(share * truth.seconds[1]):
        process.send(signal.SIGKILL)
    process.end()


def _may_mount(folder: Path) -> bool:
    if os.geteuid() != 0:
        return False
    try:
        with _disk(folder / "disk", ENOUGH):
            return True
    except (OSError, subprocess.CalledProcessError):
        return False


@contextmanager
def _disk(place: Path, size: str) -> Iterator[Path]:
    """A disk in memory of that size, in a new folder."""
    place.mkdir()
    try:
        _command("mount", "-t", "tmpfs", "-o", f"size={size}", "rubgen-faults", str(place))
        try:
            yield place
        finally:
            _command("umount", str(place))
    finally:
        place.rmdir()


def _remount(place: Path, option: str) -> None:
    _command("mount", "-o", f"remount,{option}", str(place))


def _command(*words: str) -> None:
    subprocess.run(words, check=True, capture_output=True)
