"""A squeeze film damper at the disk centre."""

from typing import Annotated

import numpy as np
from pydantic.dataclasses import dataclass

from rubgen.arrays import AnyArray, FloatArray
from rubgen.machine.quantities import STRICT, Length, Viscosity, about
from rubgen.machine.support_laws.law import SupportLaw, Terms


@dataclass(frozen=True, kw_only=True, config=STRICT)
class SqueezeFilm(SupportLaw):
    """Short squeeze film damper beside the lateral spring: a centred journal that does not turn, in a full film of oil.

    The Reynolds equation of a short bearing (Ocvirk), integrated over the whole film, without cavitation. The force on
    the journal is F = -C v with v its absolute velocity. Along and across its eccentricity e = epsilon c,

        C_rr = C_0 (1 + 2 epsilon^2) / (1 - epsilon^2)^(5/2),   C_tt = C_0 / (1 - epsilon^2)^(3/2),
        C_0  = pi mu R (L / c)^3

    (Barrett, Gunter 1975, NASA CR-2548, with the whole circle as the range of the integrals). A cavitated film has
    about half of C_0 and a stiffness of its own. Fluid inertia, supply grooves and end seals are left out.
    """

    radius_m: Annotated[Length, about("Radius of the journal.")]
    length_m: Annotated[Length, about("Axial length of the film. The damping grows with its third power.")]
    clearance_m: Annotated[Length, about("Radial gap of the film. The damping falls with its third power.")]
    viscosity_pa_s: Annotated[Viscosity, about("Dynamic viscosity of the oil at its temperature: 0.001 to 1.")]

    @property
    def centred_damping_n_s_per_m(self) -> float:
        """Damping of the centred film, C_0 = pi mu R (L / c)^3, in N s/m."""
        return float(np.pi * self.viscosity_pa_s * self.radius_m * (self.length_m / self.clearance_m) ** 3)

    @property
    def limit_m(self) -> float:
        """Eccentricity in m at which the film closes: the clearance."""
        return self.clearance_m

    def force(self, _theta: AnyArray, u: AnyArray, v: AnyArray) -> AnyArray:
        """Return the film's force -C(u) v, with C = C_0 (1 - eps^2)^(-3/2) [1 + 3 u u^T / (c^2 (1 - eps^2))]."""
        square = self.clearance_m**2
        rest = 1 - np.sum(u * u, axis=-1, keepdims=True) / square
        along = 3 * u * np.sum(u * v, axis=-1, keepdims=True) / (square * rest)
        return np.asarray(-(self.centred_damping_n_s_per_m * rest**-1.5 * (v + along)))

    @property
    def numbers(self) -> tuple[float, ...]:
        """C_0 in N s/m and the clearance c in m."""
        return self.centred_damping_n_s_per_m, self.clearance_m

    @staticmethod
    def terms(numbers: FloatArray, _cosine: float, _sine: float, x: float, y: float) -> Terms:
        """Return no spring force and the damping matrix C(u) of the method `force`: (0, 0, C_xx, C_xy, C_yx, C_yy).

        The arguments are as in `SupportLaw.terms`. Valid for |u| below the clearance.
        """
        centred, clearance = numbers[0], numbers[1]
        rest = 1.0 - (x * x + y * y) / (clearance * clearance)
        even = centred / (rest * rest**0.5)
        along = 3.0 * even / (rest * clearance * clearance)
        return 0.0, 0.0, even + along * x * x, along * x * y, along * x * y, even + along * y * y
