"""Full finite-element model and reduction of the preset: without and with the cache, each in a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile

PROGRAM = """
import time
from rubgen.machine import load_machine
from rubgen.scenario import Reduction
from rubgen.reduction import reduce
start = time.perf_counter()
model = reduce(load_machine("zeng2019"), Reduction())
model.at_speed(1000.0)
print(time.perf_counter() - start)
"""


def measure() -> list[dict[str, object]]:
    with tempfile.TemporaryDirectory() as cache:
        cold, warm = _seconds(cache), _seconds(cache)
    return [
        {"name": "full model and reduction, cold", "value": cold, "unit": "s", "target": "<= 15"},
        {"name": "full model and reduction, from cache", "value": warm, "unit": "s", "target": "<= 1"},
        {"name": "reduction, cold over cached", "value": cold / warm, "unit": "ratio", "target": "recorded"},
    ]


def _seconds(cache: str) -> float:
    environment = {**os.environ, "RUBGEN_CACHE_DIR": cache}
    done = subprocess.run([sys.executable, "-c", PROGRAM], check=True, capture_output=True, text=True, env=environment)
    return float(done.stdout)
