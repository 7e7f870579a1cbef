"""An oil film that turns with the journal: the law of oil whirl and oil whip."""

import math
from dataclasses import dataclass

import numpy as np

from rubgen.arrays import AnyArray, FloatArray
from rubgen.machine.support_laws.law import SupportLaw, Terms


@dataclass(frozen=True, kw_only=True)
class WhirlingFilm(SupportLaw):
    """A turning oil film, against which the dampers of the support act. At its centre it is softer than the support.

    F = q (swirl e_z x u + soft u), q = 1 / (1 + |u|^2 / scale^2)

    The dampers c of the support act against the mean oil, F_d = -c (v - lambda q Omega e_z x u): with swirl = c lambda
    Omega this is the cross-coupled stiffness of Muszynska (1986). The film has the stiffness k - soft at its centre and
    k far from it. Both non-linear terms are bounded, so the whirl is bounded too.
    """

    SETTLES = True

    swirl_n_per_m: float
    """Cross-coupled stiffness c lambda Omega at the centre, N/m."""
    soft_n_per_m: float
    """Stiffness that the film lacks at its centre, N/m."""
    scale_m: float
    """Eccentricity at which the mean speed of the oil has halved, m."""

    def force(self, _theta: AnyArray, u: AnyArray, _v: AnyArray) -> AnyArray:
        """Return q (swirl e_z x u + soft u): the cross-coupled and the direct part, at any theta."""
        q = 1 / (1 + np.sum(u * u, axis=-1, keepdims=True) / self.scale_m**2)
        across = np.stack([-u[..., 1], u[..., 0]], axis=-1)
        return np.asarray(q * (self.swirl_n_per_m * across + self.soft_n_per_m * u))

    @property
    def numbers(self) -> tuple[float, ...]:
        """Cross-coupled stiffness and lacking stiffness in N/m, scale in m."""
        return self.swirl_n_per_m, self.soft_n_per_m, self.scale_m

    @staticmethod
    def terms(numbers: FloatArray, _cosine: float, _sine: float, x: float, y: float) -> Terms:
        """Return the spring force q (swirl e_z x u + soft u) at u = (x, y), and zero damping.

        The arguments are as in `SupportLaw.terms`.
        """
        q = 1.0 / (1.0 + (x * x + y * y) / (numbers[2] * numbers[2]))
        across, along = q * numbers[0], q * numbers[1]
        return along * x - across * y, along * y + across * x, 0.0, 0.0, 0.0, 0.0

    @property
    def stiffening_n_per_m(self) -> float:
        """Bound of the stiffness in N/m that the law adds: the largest eigenvalue of its symmetric tangent stiffness.

        Radially it stiffens by at most soft / 8, and its symmetric shear part is at most swirl / 4.
        """
        return self.soft_n_per_m / 16 + math.hypot(self.soft_n_per_m / 16, self.swirl_n_per_m / 4)
