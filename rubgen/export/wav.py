"""WAV files of 32-bit floats, with a track for each channel."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rubgen.export.run import ExportedRun


def write_wav(runs: Iterator[ExportedRun], path: Path) -> None:
    """Write one run as a WAV file, with the tracks in the order of `channels.csv`.

    `runs` must yield exactly one run, else ValueError is raised. Values are in the units of the channels, so a player
    clips values beyond 1. The sample rate must be a whole number: `export` checks it.
    """
    from scipy.io import wavfile

    (run,) = runs
    wavfile.write(path, int(run.sample_rate_hz), np.column_stack([channel.values for channel in run.channels]))
