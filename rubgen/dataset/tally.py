"""Count what a finished set holds, by split: runs, machines, classes; and how failed runs differ from good ones."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import pyarrow as pa

from rubgen.io.parquet.read import ParquetSource
from rubgen.io.parquet.words import with_words
from rubgen.scenario.vary import PARAMETERS

COUNTED = ["split", "machine_id", "status", "rub", "motion"]
NOTEWORTHY = 0.1
"""A parameter is listed where its two means differ by more than this share of the mean over good runs."""


@dataclass
class SplitTally:
    """Counts of one split."""

    runs: int = 0
    machines: int = 0
    """Machines, each in this split alone."""
    status: Counter[str] = field(default_factory=Counter)
    rub: int = 0
    """Good runs with rub."""
    motion: Counter[str] = field(default_factory=Counter)
    """Good runs by class of motion."""


@dataclass(frozen=True, kw_only=True)
class Shift:
    """A parameter whose mean over failed runs differs from its mean over good runs; both means are in `unit`."""

    key: str
    unit: str
    good: float
    failed: float


@dataclass(frozen=True, kw_only=True)
class Tally:
    """Counts of a set by the name of the split, and the parameters in which failed runs differ from good runs."""

    splits: dict[str, SplitTally]
    shifts: tuple[Shift, ...]


def tally_of(runs: Path) -> Tally:
    """Count the runs of a set in its file `runs.parquet`: runs, machines, status, rub and motion, by split.

    The result also lists the parameters whose means over failed and good runs differ by more than the share NOTEWORTHY
    of the mean over good runs. One row group and the names of all machines are in memory. Raises UserError where the
    file is missing or damaged.
    """
    splits: dict[str, SplitTally] = {}
    machines: set[tuple[str, str]] = set()
    sums = {good: Counter[str]() for good in (True, False)}
    counts = {True: 0, False: 0}
    keys = [each.key for each in PARAMETERS]
    for table in _groups(runs, [*COUNTED, *keys]):
        for row in with_words(table).to_pylist():
            mine, good = splits.setdefault(row["split"], SplitTally()), row["status"] == "ok"
            mine.runs += 1
            machine = row["split"], row["machine_id"]
            mine.machines += machine not in machines
            machines.add(machine)
            mine.status[row["status"]] += 1
            mine.rub += bool(good and row["rub"])
            mine.motion.update([row["motion"]] if good else [])
            counts[good] += 1
            sums[good].update({key: row[key] for key in keys})
    return Tally(splits=splits, shifts=tuple(_shifts(sums, counts)))


def _groups(runs: Path, columns: list[str]) -> Iterator[pa.Table]:
    with ParquetSource(runs) as file:
        for group in range(file.num_row_groups):
            yield file.read_row_group(group, columns)


def _shifts(sums: dict[bool, Counter[str]], counts: dict[bool, int]) -> Iterator[Shift]:
    if not all(counts.values()):
        return
    for each in PARAMETERS:
        good, failed = (float(sums[kind][each.key]) / counts[kind] for kind in (True, False))
        if abs(failed - good) > NOTEWORTHY * abs(good):
            yield Shift(key=each.key, unit=each.unit, good=good, failed=failed)
