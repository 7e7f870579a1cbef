"""The windows of a data set as models see them: features, random convolutions, and what each window belongs to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray
from rubgen.baseline.rocket import Rocket, fitted
from rubgen.dataset.making.workers import unordered, worker_pool
from rubgen.dataset.reading.open import DataSet
from rubgen.features.plan import IDS
from rubgen.features.write import write_features
from rubgen.measurement.channel import Float32Array

WINDOWS = 4
"""Windows that each signal is cut into: a leak needs several of one run."""
FITTED_ON = 24
"""Runs of which a window each sets the biases of random convolutions."""
RUNS_PER_JOB = 8
TRAIN = "train"


@dataclass(frozen=True)
class SetWindows:
    """All windows of the good runs of a set."""

    runs: npt.NDArray[np.str_]
    """(windows,): name of the run."""
    edges: FloatArray
    """(windows, 2): start and end in s from the first sample of the run's signals."""
    splits: npt.NDArray[np.str_]
    """(windows,)"""
    groups: npt.NDArray[np.str_]
    """(windows,): what must stay on one side."""
    inputs: dict[str, FloatArray]
    """(windows, numbers) by name: "features", NaN where undefined, and "rocket 0", "rocket 1", ... of each seed."""


def windows_of(directory: Path, data: DataSet, seeds: int, workers: int) -> SetWindows:
    """Compute WINDOWS windows of equal length of each good run of `data`, the set in `directory`, run by run.

    - seeds: number of choices of random convolutions.
    - workers: number of processes.
    """
    import pandas as pd

    channels = [sensor.name for sensor in data.sensors.sampled if sensor.name in data.inputs]
    with TemporaryDirectory() as folder:
        path = Path(folder) / "features.parquet"
        size = round(data.signal_seconds * data.sample_rate_hz) // WINDOWS
        length = f"{size / data.sample_rate_hz:.9f}s"
        write_features(directory, path, window=length, channels=channels, workers=workers)
        table = pd.read_parquet(path)
    runs = table["run_id"].to_numpy(dtype=np.str_)
    start = table["start_s"].to_numpy()
    names = list(data.ok.index)
    of_run = np.searchsorted(np.sort(names), runs)
    groups = data.groups_of(sorted(names))[of_run]
    inputs = {"features": table.iloc[:, len(IDS) :].to_numpy(dtype=np.float64)}
    inputs |= _rockets(directory, data, channels, seeds, workers)
    edges = np.column_stack([start, start + table["seconds"].to_numpy()])
    return SetWindows(runs, edges, table["split"].to_numpy(dtype=np.str_), groups, inputs)


def _rockets(directory: Path, data: DataSet, channels: Sequence[str], seeds: int, workers: int) -> dict[str, Any]:
    good = list(data.ok.index)
    learned = list(data.ok.index[data.ok["split"] == TRAIN]) or good
    chosen = sorted(np.random.default_rng(0).permutation(learned)[:FITTED_ON])
    rng = np.random.default_rng(1)
    examples = [_cut(signals, channels)[rng.integers(WINDOWS)] for _, signals, _ in data.recorded(chosen, channels)]
    rocket = fitted(np.array(examples), seeds)
    firsts = range(0, len(good), RUNS_PER_JOB)
    jobs = [(directory, tuple(channels), rocket, at, good[at : at + RUNS_PER_JOB]) for at in firsts]
    with worker_pool(min(workers, len(jobs))) as pool:
        found = dict(unordered(pool, _rockets_of, jobs))
    return {f"rocket {seed}": np.concatenate([found[at][seed] for at in firsts]) for seed in range(seeds)}


def _rockets_of(
    directory: Path, channels: tuple[str, ...], rocket: Rocket, number: int, runs: list[str]
) -> tuple[int, Float32Array]:
    """Return the numbers of all windows of these runs (seeds, windows, numbers), after `number`."""
    cut = [_cut(signals, channels) for _, signals, _ in _opened(directory).recorded(runs, channels)]
    return number, np.array([rocket.transform(window) for windows in cut for window in windows]).swapaxes(0, 1)


def _cut(signals: dict[str, Float32Array], channels: Sequence[str]) -> Float32Array:
    """Return the windows (windows, channels, samples) of a run, as `rubgen features` cuts them."""
    stacked = np.array([signals[name] for name in channels])
    size = stacked.shape[1] // WINDOWS
    return stacked[:, : size * WINDOWS].reshape(len(channels), WINDOWS, size).swapaxes(0, 1)


@lru_cache(maxsize=1)
def _opened(directory: Path) -> DataSet:
    return DataSet(directory)
