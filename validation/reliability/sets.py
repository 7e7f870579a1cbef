"""The small set of the campaign, made once undisturbed, and what it is compared with."""

from __future__ import annotations

import hashlib
import json
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import rubgen
from rubgen.cli.commands import generating
from rubgen.dataset.checking import verify
from rubgen.io import mcap
from rubgen.io.parquet import compact_records, read, write
from rubgen.machine.load import PRESETS
from rubgen.viz import rerun
from validation.reliability.processes import Process, start
from validation.reliability.rows import Row

RUNS = 2
RECIPE = """\
name = "fault"
seed = 1
runs = {runs}
machine = "machine.toml"
[vary]
speed_rpm = 7000
clearance_m = 2.5e-4
casing_support_stiffness_n_per_m = 4e5
friction = {{ uniform = [0.0, 0.01] }}
[operation]
profile = "run-up"
end_speed_rpm = 7300
duration_s = 0.06
[simulation]
settle_turns = 10
steps_per_turn = 512
[reduction]
blade_modes = 1
disk_modes = 1
blisk_modes = 1
casing_modes = 5
[sensors]
sample_rate_hz = 8000
[output]
formats = {formats}
signal_seconds = 0.05
"""
"""Runs of 0.1 s: a run-up need not have the 500 turns of a steady record."""
SMALLER = {"count = 36": "count = 8", "circumferential_elements = 72": "circumferential_elements = 32"}
"""What makes the preset a machine of eight blades, on which a run takes a third of the time."""


LOADED = (generating, verify, mcap, read, compact_records, write, rerun)
"""Modules that commands import late, and that forks of this process need not import again."""


@dataclass
class Truth:
    """A recipe, the bytes of its undisturbed set, and how long it takes with a number of workers."""

    folder: Path
    recipe: Path
    directory: Path
    digests: dict[str, str]
    seconds: dict[int, float] = field(default_factory=dict)
    made: int = 0

    def new_directory(self) -> Path:
        """A place for one more making."""
        self.made += 1
        return self.folder / f"set-{self.made:04d}"

    def generate(self, out: Path, *, workers: int = 1, log: str = "command", **how: Any) -> Process:
        """Begin or complete the set in `out`, in a process of its own."""
        arguments = ["generate", str(self.recipe), "--out", str(out), "--workers", str(workers), "--json"]
        return start(arguments, self.folder / f"{log}.log", **how)

    def complete(self, out: Path, row: Row, what: str, **how: Any) -> None:
        """Give the same command again; count a set that is not completed, or differs. Then remove it."""
        process = self.generate(out, **how)
        if process.end() != 0:
            row.fail("lost", f"{what}: then {process.code}: {process.output.strip()[-300:]}")
        elif digests(out) != self.digests:
            row.fail("differing", f"{what}: {differences(digests(out), self.digests)}")
        if "Traceback" in process.output:
            row.fail("tracebacks", f"{what}: when it was completed")
        shutil.rmtree(out, ignore_errors=True)


@contextmanager
def undisturbed(formats: tuple[str, ...] = ("parquet", "mcap"), runs: int = RUNS) -> Iterator[Truth]:
    """The set, made in a temporary folder with one worker. This process then has all kernels loaded."""
    with tempfile.TemporaryDirectory(prefix="rubgen-faults-") as name:
        folder = Path(name)
        folder.chmod(0o755)
        recipe = folder / "recipe.toml"
        recipe.write_text(RECIPE.format(runs=runs, formats=json.dumps(formats)), encoding="utf-8")
        (folder / "machine.toml").write_text(_small_machine(), encoding="utf-8")
        rubgen.simulate(rubgen.load_recipe(recipe).scenario(0))  # loads all kernels
        truth = Truth(folder=folder, recipe=recipe, directory=folder / "undisturbed", digests={})
        begun = time.monotonic()
        process = truth.generate(truth.directory)
        if process.end() != 0:
            raise RuntimeError(f"the undisturbed set cannot be made: {process.output}")
        truth.seconds[1] = time.monotonic() - begun
        truth.digests |= digests(truth.directory)
        if "mcap/0000/run-000001.mcap" not in truth.digests:
            raise RuntimeError(f"a run of the undisturbed set has no recording: {process.output}")
        yield truth


def _small_machine() -> str:
    text = (PRESETS / "zeng2019.toml").read_text(encoding="utf-8")
    for old, new in SMALLER.items():
        if old not in text:
            raise RuntimeError(f"the preset has no {old}")
        text = text.replace(old, new)
    return text


def digests(directory: Path) -> dict[str, str]:
    """The sha256 of every file by its path; of .rrd files, whose bytes differ from making to making, the name."""
    files = sorted(path for path in directory.rglob("*") if not path.is_dir())
    return {path.relative_to(directory).as_posix(): _sha256(path) for path in files}


def differences(one: dict[str, str], other: dict[str, str]) -> str:
    """The files in which two sets differ."""
    return ", ".join(sorted(name for name in one.keys() | other.keys() if one.get(name) != other.get(name)))


def kept_runs(directory: Path) -> dict[str, tuple[int, int]]:
    """The finished runs of an unfinished set, with what changes where one is made again."""
    paths = (directory / ".staging" / "runs").glob("run-*[0-9].parquet")
    return {path.name: (path.stat().st_ino, path.stat().st_mtime_ns) for path in paths}


def _sha256(path: Path) -> str:
    return "" if path.suffix == ".rrd" else hashlib.sha256(path.read_bytes()).hexdigest()
