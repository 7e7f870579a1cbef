"""A lateral spring that turns with the shaft and opens under its weight: the law of a breathing crack."""

import math
from dataclasses import dataclass

import numpy as np

from rubgen.arrays import AnyArray, FloatArray
from rubgen.machine.support_laws.law import SupportLaw, Terms


@dataclass(frozen=True, kw_only=True)
class BreathingSpring(SupportLaw):
    """Along a direction of the turning frame the lateral spring loses stiffness while the direction points down.

    F = lost f(theta) s e, with s = u . e, e the direction at the angle gamma in the turning frame, and f = (1 -
    sin(theta + gamma)) / 2: 1 where e points along gravity (-Y), 0 where it points up (Mayes, Davies 1984).
    """

    LINEAR = True
    TURNS = True

    lost_n_per_m: float
    """Stiffness that is lost with the crack open, N/m."""
    direction_rad: float
    """Angle gamma of the direction in the turning frame, rad."""

    def force(self, theta: AnyArray, u: AnyArray, _v: AnyArray) -> AnyArray:
        """Return the force lost f(theta) s e (..., 2), N, which cancels stiffness of the support along e."""
        e = np.array([math.cos(self.direction_rad), math.sin(self.direction_rad)])
        opening = (1 - np.sin(theta + self.direction_rad)) / 2
        return np.asarray(self.lost_n_per_m * opening[..., None] * np.sum(u * e, axis=-1, keepdims=True) * e)

    @property
    def numbers(self) -> tuple[float, ...]:
        """Lost stiffness in N/m, cosine and sine of the direction's angle gamma."""
        return self.lost_n_per_m, math.cos(self.direction_rad), math.sin(self.direction_rad)

    @staticmethod
    def terms(numbers: FloatArray, cosine: float, sine: float, x: float, y: float) -> Terms:
        """Return the spring force lost f(theta) s e at u = (x, y), and zero damping.

        The arguments are as in `SupportLaw.terms`.
        """
        e_x, e_y = numbers[1], numbers[2]
        opening = 0.5 * (1.0 - (sine * e_x + cosine * e_y))
        force = numbers[0] * opening * (e_x * x + e_y * y)
        return force * e_x, force * e_y, 0.0, 0.0, 0.0, 0.0
