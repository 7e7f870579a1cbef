"""The base class of a law of the disk support."""

import math
from abc import ABC, abstractmethod
from typing import ClassVar

from rubgen.arrays import AnyArray, FloatArray

Terms = tuple[float, float, float, float, float, float]
"""A spring's force along x and y in N, and the damping D_xx, D_xy, D_yx, D_yy in N s/m."""


class SupportLaw(ABC):
    """A force s(u) - D(u) v on the disk centre, in addition to its linear springs and dampers.

    u is the displacement of the disk centre in m and v its absolute velocity in m/s, both along the axes of the turning
    frame, which has turned by theta in rad. The law is written twice in its file: `force` for whole arrays, `terms` for
    the compiled step. The fields of a law that is a key of `DiskSupport` are its keys in a machine file. Faults make
    other laws.
    """

    LINEAR: ClassVar[bool] = False
    """Whether the force is linear in u and v, so that there is one motion without rub."""
    TURNS: ClassVar[bool] = False
    """Whether the force depends on theta: it is not alike in all directions."""
    SETTLES: ClassVar[bool] = False
    """Whether the motion without rub is not known before the run: it may be of many periods, chaotic or self-excited.

    The run starts from the motion without this law and settles longer."""

    @abstractmethod
    def force(self, theta: AnyArray, u: AnyArray, v: AnyArray) -> AnyArray:
        """Return the force (..., 2) in N at the angles theta (...), displacements u and absolute velocities v (..., 2).

        u and v are real or complex, since derivatives are taken by complex steps. The function is analytic, or
        piecewise analytic; the real part of u then selects the piece.
        """

    @property
    @abstractmethod
    def numbers(self) -> tuple[float, ...]:
        """The constants of the law that `terms` takes."""

    @staticmethod
    @abstractmethod
    def terms(numbers: FloatArray, cosine: float, sine: float, x: float, y: float) -> Terms:
        """Return the spring force s_x, s_y (N) and the damping D_xx, D_xy, D_yx, D_yy (N s/m) at u = (x, y).

        - numbers: what the property `numbers` returns.
        - cosine, sine: cosine and sine of theta.
        - x, y: displacement of the disk centre along the axes of the turning frame, m. The result has these axes too.

        The solver compiles this function and calls it in every step. It may use arithmetic, `math` and constants of its
        own file. The scheme takes D implicitly, so a D with v^T D v >= 0 for every v never adds energy.
        """

    @property
    def limit_m(self) -> float:
        """Eccentricity in m up to which the law is valid. A run that reaches it ends as `film-closed`.

        Infinite by default.
        """
        return math.inf

    @property
    def stiffening_n_per_m(self) -> float:
        """Largest stiffness in N/m that the law adds to the support. It shortens the stable time step."""
        return 0.0
