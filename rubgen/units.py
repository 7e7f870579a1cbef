"""Units of the field beside SI: rev/min and g."""

import math
from typing import TypeVar

from rubgen.arrays import FloatArray

Speed = TypeVar("Speed", float, FloatArray)

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of free fall, one g, in m/s2 (ISO 80000-3)."""
_RPM = 0.10471975511965977
"""One rev/min in rad/s, 2 pi / 60."""


def rad_per_s(rpm: Speed) -> Speed:
    """A speed in rad/s from the same in rev/min, or an acceleration in rad/s2 from rev/min/s."""
    return rpm * _RPM


def rev_per_min(speed: Speed) -> Speed:
    """A speed in rev/min from the same in rad/s."""
    return speed * 30 / math.pi
