"""Text: CSV files of one run each, and .ts files of sktime and aeon with all runs of a split."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
from pyarrow import csv

from rubgen.export.run import ExportedRun


def write_csv(runs: Iterator[ExportedRun], path: Path) -> None:
    """Write one run as CSV: `time_s`, then a column for each channel with its unit in the header.

    `runs` must yield exactly one run, else ValueError is raised. Values keep all their digits.
    """
    (run,) = runs
    columns: dict[str, Any] = {"time_s": np.arange(run.samples) / run.sample_rate_hz}
    columns |= {f"{channel.name} [{channel.unit}]": channel.values for channel in run.channels}
    csv.write_csv(pa.table(columns), path, csv.WriteOptions(quoting_style="needed"))


def write_ts(runs: Iterator[ExportedRun], path: Path) -> None:
    """Write runs as cases of equal length, one dimension for each channel, with the class `rub` (`true` or `false`).

    The head of the file names channels, units and sample rate in comments.
    """
    with path.open("w", encoding="utf-8", newline="\n") as stream:
        for number, run in enumerate(runs):
            if number == 0:
                stream.write(_head(run))
            dimensions = [",".join(map(str, channel.values.tolist())) for channel in run.channels]
            stream.write(":".join([*dimensions, str(run.row["rub"]).lower()]) + "\n")


def _head(run: ExportedRun) -> str:
    channels = "".join(f"# dimension {n}: {c.name} in {c.unit}\n" for n, c in enumerate(run.channels))
    univariate = str(len(run.channels) == 1).lower()
    return (
        f"# {run.sample_rate_hz!r} samples a second\n{channels}@problemName rubgen\n@timeStamps false\n@missing false\n"
        f"@univariate {univariate}\n@dimensions {len(run.channels)}\n@equalLength true\n@seriesLength {run.samples}\n"
        "@classLabel true false true\n@data\n"
    )
