"""Write the table of features of a data set, run after run: neither signals nor table must fit into memory."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from rubgen.dataset.making.workers import unordered, worker_pool
from rubgen.dataset.reading.open import DataSet
from rubgen.errors import UserError
from rubgen.features.generic import generic_features
from rubgen.features.of_run import run_features
from rubgen.features.plan import IDS, Plan, make_plan
from rubgen.features.vocabulary import GENERIC
from rubgen.io.files import write_durably
from rubgen.linalg.threads import one_blas_thread
from rubgen.progress import count

RUNS_PER_JOB = 8
"""Runs that a process reads together, as they lie together in the files: one row group of the table each."""


@dataclass(frozen=True)
class Written:
    """What a table of features contains."""

    runs: int
    windows: int
    columns: int
    """Features of one window."""
    channels: tuple[str, ...]
    sets: tuple[str, ...]


def write_features(
    directory: Path | str,
    out: Path | str,
    *,
    window: str | None = None,
    channels: Sequence[str] | None = None,
    sets: Sequence[str] | None = None,
    workers: int = 1,
) -> Written:
    """Write the features of every good run of the set in `directory` to the Parquet file `out`, a row for each window.

    - window, channels, sets: as in `make_plan`; None takes the whole signal, all channels and all sets but tsfel.
    - workers: number of processes.

    The bytes depend on the data set, the parameters and the versions of the packages, not on `workers`. The file is
    complete or not written at all. An existing file is replaced; its folder must exist. Raises UserError as `make_plan`
    and `run_features` do, for a set without good runs, and for the set tsfel if it is not installed.
    """
    data = DataSet(directory)
    good = list(data.ok.index)
    if not good:
        raise UserError(f"{data.layout.root}: no run of this set ended well; there is nothing to compute")
    plan = _with_generic(make_plan(data, window, channels, sets), data, good[0])
    jobs = [
        (directory, plan, number, good[number : number + RUNS_PER_JOB]) for number in range(0, len(good), RUNS_PER_JOB)
    ]
    windows = 0

    def write(part: Path) -> None:
        nonlocal windows
        with (
            worker_pool(min(workers, len(jobs))) as pool,
            pq.ParquetWriter(part, plan.schema(), compression="zstd") as file,
        ):
            done = unordered(pool, _features_of, jobs)
            for table in _in_order(done):
                file.write_table(table, row_group_size=table.num_rows)
                windows += table.num_rows
                count(windows, 0)

    write_durably(Path(out), write)
    return Written(len(good), windows, len(plan.schema()) - len(IDS), plan.channels, plan.sets)


def features_of(data: DataSet, plan: Plan, run_ids: Sequence[str]) -> pa.Table:
    """Compute the rows of the runs `run_ids`, at least one, in this order, as `run_features` does.

    If the plan has the set tsfel, `plan.generic` must name its features: `make_plan` does not.
    """
    tables = []
    for run_id, signals, pulses in data.recorded(run_ids, plan.channels):
        row = data.row(run_id)
        with one_blas_thread():  # as in a worker: the bytes depend on it
            tables.append(run_features(plan, (run_id, row["machine_id"], row["split"]), signals, pulses))
    return pa.concat_tables(tables).combine_chunks()


def _with_generic(plan: Plan, data: DataSet, first: str) -> Plan:
    """Name the features of tsfel, which it does not list: those of the first channel of the run `first`."""
    if GENERIC not in plan.sets:
        return plan
    ((_, signals, pulses),) = data.recorded([first], plan.channels[:1])
    signal = signals[plan.channels[0]].astype(np.float64)
    cuts = plan.window.cuts(signal.size, plan.rate_hz, pulses) if plan.window else [(0, signal.size)]
    start, size = (cuts or [(0, signal.size)])[0]
    return replace(plan, generic=tuple(generic_features(signal[start : start + size], plan.rate_hz)))


def _features_of(directory: Path | str, plan: Plan, number: int, run_ids: list[str]) -> tuple[int, pa.Table]:
    return number, features_of(_opened(directory), plan, run_ids)


@lru_cache(maxsize=1)
def _opened(directory: Path | str) -> DataSet:
    return DataSet(directory)


def _in_order(done: Iterator[tuple[int, pa.Table]]) -> Iterator[pa.Table]:
    """Yield the tables of jobs in their order. Only those that came too early wait in memory."""
    early: dict[int, pa.Table] = {}
    following = 0
    for number, table in done:
        early[number] = table
        while following in early:
            yield early.pop(following)
            following += RUNS_PER_JOB
