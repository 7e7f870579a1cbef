"""A lateral spring that gives way on one side: the law of a loose support."""

import math
from dataclasses import dataclass

import numpy as np

from rubgen.arrays import AnyArray, FloatArray
from rubgen.machine.support_laws.law import SupportLaw, Terms


@dataclass(frozen=True, kw_only=True)
class LooseSpring(SupportLaw):
    """Beyond a gap along a direction of the inertial frame, the lateral spring loses a part of its stiffness.

    F = lost (s - gap) e for s > gap, else 0, with s = u . e and e the direction. With the lateral spring k the support
    has the stiffness k below the gap and k - lost beyond it: a bilinear spring.
    """

    TURNS = True
    SETTLES = True

    lost_n_per_m: float
    """Stiffness that is lost beyond the gap, N/m."""
    gap_m: float
    """Displacement of the disk centre along the direction from which on it is lost, m."""
    direction_rad: float
    """Angle of the direction, inertial, rad."""

    def force(self, theta: AnyArray, u: AnyArray, _v: AnyArray) -> AnyArray:
        """Return the force lost (s - gap) e where s > gap, else 0. The real part of s chooses the side."""
        e = np.stack([np.cos(self.direction_rad - theta), np.sin(self.direction_rad - theta)], axis=-1)
        beyond = np.sum(u * e, axis=-1, keepdims=True) - self.gap_m
        return np.asarray(np.where(beyond.real > 0, self.lost_n_per_m * beyond, 0.0) * e)

    @property
    def numbers(self) -> tuple[float, ...]:
        """Lost stiffness in N/m, gap in m, cosine and sine of the direction's angle."""
        return self.lost_n_per_m, self.gap_m, math.cos(self.direction_rad), math.sin(self.direction_rad)

    @staticmethod
    def terms(numbers: FloatArray, cosine: float, sine: float, x: float, y: float) -> Terms:
        """Return the spring force lost (s - gap) e where s > gap, at u = (x, y), and zero damping.

        The arguments are as in `SupportLaw.terms`.
        """
        e_x = numbers[2] * cosine + numbers[3] * sine
        e_y = numbers[3] * cosine - numbers[2] * sine
        force = numbers[0] * max(e_x * x + e_y * y - numbers[1], 0.0)
        return force * e_x, force * e_y, 0.0, 0.0, 0.0, 0.0
