"""MAT files of version 5, for MATLAB, Octave and scipy."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from rubgen.export.run import ExportedRun, without_nulls

LONGEST_NAME = 63


def write_mat(runs: Iterator[ExportedRun], path: Path) -> None:
    """Write one run to a MAT file: a struct for each channel, `once_per_rev_s`, and the struct `run`.

    `runs` must yield exactly one run, else ValueError is raised. A channel has `values`, `unit`, `sample_rate_hz` and
    the description of its sensor. `run` has parameters and labels; an undefined label is an empty array.
    """
    from scipy.io import savemat

    (run,) = runs
    content: dict[str, Any] = {
        each.name: {"values": each.values, "unit": each.unit, "sample_rate_hz": run.sample_rate_hz, **each.facts}
        for each in run.channels
    }
    content["once_per_rev_s"] = run.pulses
    content["run"] = {name[:LONGEST_NAME]: _value(value) for name, value in run.row.items()}
    savemat(path, content, appendmat=False, long_field_names=True, oned_as="column", do_compression=True)
    with path.open("rb+") as stream:
        stream.write(b"MATLAB 5.0 MAT-file, rubgen".ljust(116))  # scipy writes the date there


def _value(value: Any) -> Any:
    if value is None:
        return np.zeros(0)
    if not isinstance(value, list):
        return value
    known = without_nulls(value)
    return np.array(known, dtype=object if known and isinstance(known[0], str) else np.float64)
