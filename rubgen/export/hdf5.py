"""HDF5 files: one data set a channel, unit and sensor as its attributes (h5py)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from rubgen.export.run import ExportedRun, without_nulls


def write_hdf5(runs: Iterator[ExportedRun], path: Path) -> None:
    """Write one run to an HDF5 file: `channels/<name>` with attributes, and `once_per_rev_s`.

    `runs` must yield exactly one run, else ValueError is raised. Parameters and labels are attributes of `/`; an
    undefined label has no attribute. An existing file is overwritten.
    """
    import h5py

    (run,) = runs
    with h5py.File(path, "w") as file:
        group = file.create_group("channels")
        for channel in run.channels:
            stored = group.create_dataset(
                channel.name, data=channel.values, compression="gzip", shuffle=True, track_times=False
            )
            stored.attrs["units"] = channel.unit
            stored.attrs["sample_rate_hz"] = run.sample_rate_hz
            for name, fact in channel.facts.items():
                stored.attrs[name] = fact
        pulses = file.create_dataset("once_per_rev_s", data=run.pulses, track_times=False)
        pulses.attrs["units"] = "s"
        for name, value in run.row.items():
            if value is not None:
                file.attrs[name] = _attribute(value, h5py)


def _attribute(value: Any, h5py: Any) -> Any:
    if not isinstance(value, list):
        return value
    return without_nulls(value) if value else h5py.Empty("f8")
