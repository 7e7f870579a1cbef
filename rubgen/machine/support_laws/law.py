"""What a law of the disk support is."""

import math
from abc import ABC, abstractmethod

from rubgen.arrays import AnyArray, FloatArray

Terms = tuple[float, float, float, float, float, float]
"""A spring's force along x and y in N, and the damping D_xx, D_xy, D_yx, D_yy in N s/m."""


class SupportLaw(ABC):
    """A force s(u) - D(u) v on the disk centre, beside its linear springs and dampers.

    u is the place of the disk centre in m and v its absolute velocity in m/s. The force must be alike in all
    directions, so that its form is the same in the inertial and in the turning frame. The fields of a law are its keys
    in a machine file. The law stands twice in its file: `force` for whole arrays, `terms` for the compiled step.
    """

    @abstractmethod
    def force(self, u: AnyArray, v: AnyArray) -> AnyArray:
        """Force (..., 2) in N of places u and absolute velocities v (..., 2), real or complex: an analytic function."""

    @property
    @abstractmethod
    def numbers(self) -> tuple[float, ...]:
        """The numbers that `terms` takes."""

    @staticmethod
    @abstractmethod
    def terms(numbers: FloatArray, x: float, y: float) -> Terms:
        """Spring force and damping at u = (x, y).

        The solver compiles this function and calls it in every step. It may use arithmetic, `math` and constants of its
        own file. The scheme takes D implicitly, so a D that is not negative never adds energy.
        """

    @property
    def limit_m(self) -> float:
        """The eccentricity at which the law ends, and a run with it as `film-closed`, in m; infinite by default."""
        return math.inf
