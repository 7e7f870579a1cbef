"""What compiling costs: CPU time of a first run with an empty cache of kernels, less the same in a new process.

It does what `rubgen generate` does before its first run. Every kernel of a run is compiled, with and without contact,
companion, surroundings and taps: they have the same code.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from rubgen.cache_root import CACHE_VARIABLE

FIRST_RUN = """
import time
from rubgen.dataset.making.warm_up import warm_up
from rubgen.scenario.load import RECIPES, load_recipe
scenario = load_recipe(RECIPES / "laboratory.toml").scenario(0)
warm_up(scenario, (), (scenario,))
print(time.process_time())
"""


def measure() -> list[dict[str, object]]:
    with tempfile.TemporaryDirectory() as cache:
        cold, warm = (_seconds(cache) for _ in range(2))
        kept = len(list(Path(cache).rglob("*.nbc")))
    return [
        {"name": "compiling all kernels of a run, CPU", "value": cold - warm, "unit": "s", "target": "<= 87"},
        {"name": "kernels that are kept as machine code", "value": kept, "unit": "1", "target": "recorded"},
    ]


def _seconds(cache: str) -> float:
    """CPU time of a new process with this cache, in s."""
    one_thread = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", CACHE_VARIABLE: cache}
    command = [sys.executable, "-c", FIRST_RUN]
    done = subprocess.run(command, check=True, capture_output=True, text=True, env=os.environ | one_thread)
    return float(done.stdout)
