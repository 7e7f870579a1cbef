"""What a virtual sensor records."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray

Float32Array = npt.NDArray[np.float32]


@dataclass(frozen=True, kw_only=True)
class Channel:
    """One recorded signal with its description; `values` (n_samples,) at the recording's sample rate, in `unit`."""

    name: str
    unit: str
    quantity: str
    axis: str
    location: str
    range_min: float
    range_max: float
    resolution: float
    noise_rms: float
    values: Float32Array
    clean: Float32Array | None = None


@dataclass(frozen=True, kw_only=True)
class Recording:
    """All channels of one run over the last `signal_seconds` of its record.

    Sample i stands at time i / sample_rate_hz. `rotation_angle` is the blisk's angle theta at the first sample, in
    [0, 2 pi); `once_per_rev` (n_pulses,) are the arrival times in s at which theta passes 0 mod 2 pi.
    """

    sample_rate_hz: float
    rotation_angle: float
    channels: dict[str, Channel]
    once_per_rev: FloatArray
