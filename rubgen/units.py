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
    """Convert a speed from rev/min to rad/s, or an acceleration from rev/min/s to rad/s2."""
    return rpm * _RPM


def rev_per_min(speed: Speed) -> Speed:
    """Convert a speed from rad/s to rev/min, or an acceleration from rad/s2 to rev/min/s."""
    return speed * 30 / math.pi
