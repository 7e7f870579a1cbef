"""The formats, one entry each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from rubgen.export.hdf5 import write_hdf5
from rubgen.export.mat import write_mat
from rubgen.export.parquet import write_parquet
from rubgen.export.run import ExportedRun
from rubgen.export.text import write_csv, write_ts
from rubgen.export.uff import write_uff
from rubgen.export.wav import write_wav
from rubgen.export.webdataset import write_webdataset


@dataclass(frozen=True)
class ExportFormat:
    """A file format."""

    ending: str
    write: Callable[[Iterator[ExportedRun], Path], None]
    runs_per_file: int | None = 1
    """None puts all runs of a split into one file."""
    needs: str = ""
    """Package of the extra rubgen[export] that writes it."""
    most_bytes: int | None = None
    """What a file of the format can hold."""
    answers: bool = True
    """Whether labels, parameters and channels that no probe can measure may be in the export."""
    whole_rate: bool = False
    """Whether the sample rate must be a whole number."""


FORMATS = {
    "uff58": ExportFormat(".uff", write_uff, needs="pyuff"),
    "mat": ExportFormat(".mat", write_mat, most_bytes=2**31),
    "hdf5": ExportFormat(".h5", write_hdf5, needs="h5py"),
    "csv": ExportFormat(".csv", write_csv),
    "wav": ExportFormat(".wav", write_wav, most_bytes=2**32 - 2**10, whole_rate=True),
    "ts": ExportFormat(".ts", write_ts, runs_per_file=None),
    "parquet": ExportFormat(".parquet", write_parquet, runs_per_file=128, answers=False),
    "webdataset": ExportFormat(".tar", write_webdataset, runs_per_file=64),
}
