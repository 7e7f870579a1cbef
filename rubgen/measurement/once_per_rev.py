"""The once-per-revolution pulse: a notch on the shaft passes a probe at theta = 0."""

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.measurement.channel import Channel

NOTCH_ANGLE = np.pi / 6
"""Angle of the notch in rad: every pulse holds at least one sample while the sample rate is 12 f_r or more."""


def pulse_channel(angle: FloatArray, name: str = "once_per_rev", *, keep_clean: bool = False) -> Channel:
    """The pulse at blisk angles `angle` (samples,) in rad: 1 from theta = 0 to NOTCH_ANGLE, else 0; logic, no noise."""
    values = (np.mod(angle, 2 * np.pi) < NOTCH_ANGLE).astype(np.float32)
    return Channel(
        name=name,
        unit="1",
        quantity="pulse",
        axis="rotation",
        location="shaft",
        range_min=0.0,
        range_max=1.0,
        resolution=1.0,
        noise_rms=0.0,
        values=values,
        clean=values if keep_clean else None,
    )


def arrival_times(first_angle: float, speed: float, seconds: float) -> FloatArray:
    """Exact times in [0, seconds) at which theta = first_angle + speed t passes 0 mod 2 pi, in s."""
    first = np.mod(-first_angle, 2 * np.pi) / speed
    count = int(np.ceil((seconds - first) * speed / (2 * np.pi)))
    times = first + np.arange(max(count, 0)) * 2 * np.pi / speed
    return np.asarray(times[times < seconds], dtype=np.float64)
