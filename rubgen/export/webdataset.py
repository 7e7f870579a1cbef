"""WebDataset: tar files of runs, each as `<run>.npy` (channels, samples) and `<run>.json`."""

from __future__ import annotations

import io
import json
import tarfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rubgen.export.run import ExportedRun


def write_webdataset(runs: Iterator[ExportedRun], path: Path) -> None:
    """Write runs to a tar file: an array (channels, samples) and a JSON document for each run.

    The JSON has the sample rate, names, units and sensors of the channels, pulses, parameters and labels.
    """
    with tarfile.open(path, "w") as tar:
        for run in runs:
            array = io.BytesIO()
            np.save(array, np.array([channel.values for channel in run.channels]))
            facts = {
                "sample_rate_hz": run.sample_rate_hz,
                "channels": [{"name": each.name, "unit": each.unit, **each.facts} for each in run.channels],
                "once_per_rev_s": run.pulses.tolist(),
                **run.row,
            }
            _add(tar, f"{run.run_id}.npy", array.getvalue())
            _add(tar, f"{run.run_id}.json", json.dumps(facts).encode())


def _add(tar: tarfile.TarFile, name: str, content: bytes) -> None:
    entry = tarfile.TarInfo(name)
    entry.size = len(content)
    tar.addfile(entry, io.BytesIO(content))
