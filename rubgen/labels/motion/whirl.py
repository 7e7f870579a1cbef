"""Find the direction of the disk centre's whirl: forward, with the rotation, or backward."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from rubgen.arrays import FloatArray

LEAST = 0.1
"""Below this |index| the orbit has no direction."""


class WhirlDirection(StrEnum):
    """Direction of the orbit of the disk centre in the inertial frame."""

    FORWARD = "forward"
    BACKWARD = "backward"
    MIXED = "mixed"


@dataclass(frozen=True)
class Whirl:
    """Direction of the whirl of the disk centre, and its `index`: 1 for a forward circle, -1 for a backward circle."""

    direction: WhirlDirection
    index: float


def whirl(orbit: FloatArray) -> Whirl | None:
    """Return the whirl of the disk centre; None where it rests or `orbit` is empty.

    `orbit` (turns, 5) are means over each turn, as in `Response.orbit`. index = mean(r x v) / (rms(r) rms(v)), with r =
    (X, Y) less its mean: the areal velocity of the orbit over the largest possible one for its size and speed
    (Cauchy-Schwarz). A forward circle has 1, a backward circle -1, a line 0. Below |index| = 0.1 the direction is
    mixed. The orbit r = p e^(i w t) + n e^(-i w t) has (|p|^2 - |n|^2) / (|p|^2 + |n|^2). It has the sign of the shape
    and directivity index (|p| - |n|) / (|p| + |n|) of Lee and Han (1998, J. Sound Vib. 211, 4).
    """
    if not len(orbit):
        return None
    x, y, size, speed, areal = orbit.mean(axis=0)
    size -= x**2 + y**2
    if size <= 0 or speed <= 0:
        return None
    index = float(np.clip(areal / np.sqrt(size * speed), -1.0, 1.0))
    if abs(index) < LEAST:
        return Whirl(WhirlDirection.MIXED, index)
    return Whirl(WhirlDirection.FORWARD if index > 0 else WhirlDirection.BACKWARD, index)
