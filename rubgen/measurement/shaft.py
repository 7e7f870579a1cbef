"""Compute the shaft's angle over the tail of a run, and the pulse once per revolution at theta = 0.

The tail is the end of a run: the steps at which the response has taps (true signals).
"""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray
from rubgen.measurement.channel import Channel
from rubgen.solver.response import Response

NOTCH_ANGLE = np.pi / 6
"""Angle of the notch in rad: every pulse has at least one sample where the sample rate is 12 f_r or more."""


def pulse_channel(angle: FloatArray, name: str = "once_per_rev", *, keep_clean: bool = False) -> Channel:
    """Make the channel of the once_per_rev pulse: 1 from theta = 0 to NOTCH_ANGLE, else 0, without noise.

    `angle` (samples,) is the angle theta of the blisk at the samples, rad. With `keep_clean` the channel has a clean
    copy.
    """
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
    """Return the exact times in [0, seconds) at which theta = first_angle + speed t passes 0 mod 2 pi, in s.

    `first_angle` is in rad, `speed` in rad/s and positive.
    """
    first = np.mod(-first_angle, 2 * np.pi) / speed
    count = int(np.ceil((seconds - first) * speed / (2 * np.pi)))
    times = first + np.arange(max(count, 0)) * 2 * np.pi / speed
    return np.asarray(times[times < seconds], dtype=np.float64)


def shaft_angle(response: Response, positions: npt.NDArray[np.floating] | npt.NDArray[np.integer]) -> FloatArray:
    """Return theta in [0, 2 pi) at `positions`, in steps from the start of the tail.

    It is exact at a changing speed too.
    """
    back = positions - response.tail_steps
    if response.changing_speed is None:
        return in_turn(back * (2 * np.pi / response.steps_per_turn))
    return in_turn(response.changing_speed.rotation.angle((response.record_steps + back) * response.dt))


def shaft_speed(response: Response, positions: npt.NDArray[np.floating] | npt.NDArray[np.integer]) -> FloatArray:
    """Return the spin speed in rad/s at `positions`, in steps from the start of the tail."""
    if response.changing_speed is None:
        return np.full(positions.size, response.speed)
    time = (response.record_steps + positions - response.tail_steps) * response.dt
    return np.asarray(response.changing_speed.rotation.speed(time), dtype=np.float64)


def pulse_times(response: Response, first_angle: float, start: float, seconds: float) -> FloatArray:
    """Return the exact times (any,) in [0, seconds) at which theta passes 0 mod 2 pi, in s.

    - response: response of the run.
    - first_angle: theta at time 0, rad; used at a steady speed only. A changing speed gives its own angle.
    - start: time 0, in s from the start of the record.
    - seconds: length of the recording, s.
    """
    if response.changing_speed is None:
        return arrival_times(first_angle, 2 * np.pi / response.turn_seconds, seconds)
    rotation = response.changing_speed.rotation
    turns = rotation.angle(np.array([start, start + seconds])) / (2 * np.pi)
    each = [rotation.time_of(2 * np.pi * k) - start for k in range(math.floor(turns[0]), math.ceil(turns[1]) + 1)]
    times = np.array(each)
    return times[(times >= 0) & (times < seconds)]


def in_turn(angle: npt.NDArray[np.floating[Any]]) -> FloatArray:
    """Reduce angles in rad to [0, 2 pi)."""
    turned = np.mod(angle, 2 * np.pi)
    return np.asarray(np.where(turned < 2 * np.pi, turned, 0.0))
