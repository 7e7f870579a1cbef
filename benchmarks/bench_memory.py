"""Peak memory of `rubgen generate` with two workers: all processes together, for few and for more runs and turns."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from pathlib import Path

RUBGEN = str(Path(sys.executable).with_name("rubgen"))
RECIPE = """
name = "memory"
seed = 1
runs = {runs}
machine = "zeng2019"
license = "CC-BY-4.0"
[vary]
speed_rpm = {{ uniform = [9000, 10000] }}
[simulation]
settle_turns = {settle}
record_turns = {turns}
[output]
formats = ["parquet", "mcap"]
signal_seconds = 1.0
"""


def measure() -> list[dict[str, object]]:
    base = _peak_megabytes(runs=10, settle=60, turns=500)
    more_runs = _peak_megabytes(runs=30, settle=60, turns=500)
    more_turns = _peak_megabytes(runs=10, settle=60, turns=1500)
    return [
        {"name": "memory, two workers, 10 runs of 500 turns", "value": base, "unit": "MB", "target": "<= 1500"},
        {"name": "memory, 30 runs over 10 runs", "value": more_runs / base, "unit": "ratio", "target": "about 1"},
        {"name": "memory, 1500 turns over 500 turns", "value": more_turns / base, "unit": "ratio", "target": "about 1"},
    ]


def _peak_megabytes(*, runs: int, settle: int, turns: int) -> float:
    with tempfile.TemporaryDirectory() as folder:
        recipe = Path(folder) / "recipe.toml"
        recipe.write_text(RECIPE.format(runs=runs, settle=settle, turns=turns), encoding="utf-8")
        command = [RUBGEN, "generate", str(recipe), "--out", str(Path(folder) / "out"), "--workers", "2"]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        peak = 0.0
        while process.poll() is None:
            peak = max(peak, sum(_proportional_kilobytes(pid) for pid in _family(process.pid)) / 1024)
            time.sleep(0.05)
        if process.returncode != 0:
            raise RuntimeError(f"{command} ended with {process.returncode}")
        return peak


def _family(root: int) -> list[int]:
    children = [int(pid) for task in Path(f"/proc/{root}/task").glob("*/children") for pid in _read(task).split()]
    return [root] + [pid for child in children for pid in _family(child)]


def _proportional_kilobytes(pid: int) -> int:
    """Proportional set size: memory shared between processes is counted once in all."""
    for line in _read(Path(f"/proc/{pid}/smaps_rollup")).splitlines():
        if line.startswith("Pss:"):
            return int(line.split()[1])
    return 0


def _read(path: Path) -> str:
    try:
        return path.read_text()
    except OSError:  # the process ended meanwhile
        return ""
