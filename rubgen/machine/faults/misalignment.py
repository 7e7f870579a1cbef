"""Misalignment of the shafts at the coupling."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal, Self

from pydantic import model_validator
from pydantic.dataclasses import dataclass

from rubgen.machine.faults.fault import Fault, HarmonicLoad, Severity
from rubgen.machine.quantities import STRICT, Angle, Length, Stiffness, about, real

if TYPE_CHECKING:
    from rubgen.machine.machine import Machine

Offset = Annotated[float, real(ge=0, le=0.1)]
SmallAngle = Annotated[float, real(ge=0, le=10)]
LoadShare = Annotated[float, real(ge=0, le=1)]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Misalignment(Fault):
    """The reaction of a flexible coupling between shafts that are not in line, as a force on the disk centre.

    A coupling with two flexible elements at a distance Z, each with the bending stiffness K_b, bends both by Delta / Z
    under a parallel offset Delta, and one by alpha under an angle alpha. With its lateral stiffness k_c = 2 K_b / Z^2
    the reaction is

        F = k_c (Delta + alpha Z / 2)

    (Gibbons 1976; Sekhar and Prabhu 1995 use it without the torque's part, as here). It stands still in the direction
    of the misalignment, `direction_deg` from +X. In every turn the elements yield unevenly, so the reaction varies at
    orders 1, 2 and 3 of the speed (Xu and Marangoni 1994): F (1 + sum_k share_kx cos k theta). The shares depend on the
    coupling and are prescribed here. The reaction does not depend on the motion, so the response is linear.
    """

    SEVERITY: ClassVar = Severity(
        column="misalignment_m", unit="m", meaning="offset of the shafts at the coupling, an angle as its offset"
    )
    kind: Annotated[Literal["misalignment"], about("Kind of this fault.")] = "misalignment"
    parallel_m: Annotated[
        Offset | None, about("Offset of the two shafts at the coupling. Give it, angular_deg or both.")
    ] = None
    angular_deg: Annotated[
        SmallAngle | None, about("Angle between the two shafts at the coupling. Give it, parallel_m or both.")
    ] = None
    direction_deg: Annotated[Angle, about("Direction of the misalignment from +X.")] = 0.0
    coupling_stiffness_n_per_m: Annotated[
        Stiffness, about("Lateral stiffness of the coupling, from its data sheet. The reaction is proportional to it.")
    ] = 2e7
    coupling_length_m: Annotated[Length, about("Distance of the two flexible elements of the coupling.")] = 0.1
    share_1x: Annotated[
        LoadShare,
        about(
            "Amplitude of the reaction at the speed of rotation, as a share of the mean reaction. It "
            "depends on the coupling."
        ),
    ] = 0.3
    share_2x: Annotated[LoadShare, about("The same at twice the speed, which is large for many couplings.")] = 0.5
    share_3x: Annotated[LoadShare, about("The same at three times the speed.")] = 0.1

    @model_validator(mode="after")
    def _has_a_size(self) -> Self:
        if self.parallel_m is None and self.angular_deg is None:
            raise ValueError("must have parallel_m or angular_deg; give one or both")
        return self

    @property
    def severity(self) -> float:
        """Offset of the shafts at the coupling, Delta + alpha Z / 2, in m."""
        return (self.parallel_m or 0.0) + math.radians(self.angular_deg or 0.0) * self.coupling_length_m / 2

    def loads(self, machine: Machine, speed: float) -> tuple[HarmonicLoad, ...]:
        """Return the reaction of the coupling at orders 0 to 3, along the direction of the misalignment."""
        reaction = self.coupling_stiffness_n_per_m * self.severity
        along = cmath.rect(reaction, math.radians(self.direction_deg))
        shares = (1.0, self.share_1x, self.share_2x, self.share_3x)
        return tuple(
            HarmonicLoad(order=order, x=share * along.real, y=share * along.imag) for order, share in enumerate(shares)
        )
