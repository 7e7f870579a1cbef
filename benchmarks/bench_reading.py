"""Reading a finished set: one channel of one run at a random place, beside bare pyarrow; and features of a window.

The set has 16 runs of the recipe `laboratory`, in the folder `out/reading`, which is made where it is missing.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

import rubgen
from benchmarks.cpu_time import cpu_time, median_time
from rubgen.features.of_run import window_features
from rubgen.features.plan import make_plan
from rubgen.linalg.threads import one_blas_thread
from rubgen.scenario.load import RECIPES

SET, RUNS, ROUNDS = Path("out/reading"), 16, 5
SETS = ["time", "order", "envelope"]


def measure() -> list[dict[str, object]]:
    recipe = rubgen.load_recipe(RECIPES / "laboratory.toml").model_copy(update={"runs": RUNS})
    rubgen.generate(recipe, SET)
    data = rubgen.open(SET)
    runs, channel = [str(name) for name in data.ok.index], data.inputs[0]
    first = cpu_time(lambda: data.signals(runs[0], [channel]))
    every = [cpu_time(lambda run=run: data.signals(run, [channel])) for run in runs * ROUNDS]
    (path,) = (SET / "signals").glob("*.parquet")
    with pq.ParquetFile(path) as file:
        groups = [*range(file.num_row_groups)] * ROUNDS
        bare = [cpu_time(lambda group=group: file.read_row_group(group, [channel])) for group in groups]
    plan = make_plan(data, None, data.channels[:11], SETS)
    ((_, signals, pulses),) = data.recorded(runs[:1], plan.channels)
    stacked = np.array([signals[name] for name in plan.channels], dtype=np.float64)
    with one_blas_thread():
        features = median_time(lambda: window_features(plan, stacked, pulses), 20) / len(plan.channels)
    rows = [
        ("reading: one channel of one run, CPU", float(np.median(every)), "<= 2"),
        ("reading: one channel, the first time, CPU", first, "recorded"),
        ("reading: one channel of a row group by bare pyarrow, CPU", float(np.median(bare)), "recorded"),
        ("features of a window of 1 s and a channel, CPU", features, "<= 2"),
    ]
    return [{"name": name, "value": 1e3 * value, "unit": "ms", "target": target} for name, value, target in rows]
