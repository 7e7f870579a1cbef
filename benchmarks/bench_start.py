"""Start-up of the command line: whole processes, median of several, beside a bare interpreter in the same run."""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from pathlib import Path

HELP = [str(Path(sys.executable).with_name("rubgen")), "--help"]


def measure() -> list[dict[str, object]]:
    bare = _median_seconds([sys.executable, "-c", "pass"])
    help_ = _median_seconds(HELP)
    return [
        {"name": "rubgen --help", "value": help_, "unit": "s", "target": "<= 0.3"},
        {"name": "rubgen --help over a bare interpreter", "value": help_ / bare, "unit": "ratio", "target": "recorded"},
    ]


def _median_seconds(command: list[str], repeats: int = 9) -> float:
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True)
        times.append(time.perf_counter() - start)
    return statistics.median(times)
