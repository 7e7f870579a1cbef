"""A casing whose centre is not on the axis of rotation."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.faults.fault import Fault, Severity, SurfaceHarmonic
from rubgen.machine.quantities import STRICT, Angle, about, real

if TYPE_CHECKING:
    from rubgen.machine.machine import Machine

Offset = Annotated[float, real(ge=0, le=0.1)]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class CasingOffCentre(Fault):
    """The casing is `offset_m` off the axis of rotation, towards `direction_deg` from +X.

    The radius of its inner surface changes by e cos(theta - direction), exact to e^2 / (2 r), with the offset e. The
    gap is narrowest on the opposite side, so the blades rub on one side. `clearance_m` is the smallest gap of the
    centred casing.
    """

    SEVERITY: ClassVar = Severity(
        column="casing_offset_m", unit="m", meaning="distance of the casing's centre from the axis of rotation"
    )
    kind: Annotated[Literal["casing-off-centre"], about("Kind of this fault.")] = "casing-off-centre"
    offset_m: Annotated[
        Offset,
        about("Distance of the casing's centre from the axis of rotation. The gap becomes smaller by it on one side."),
    ]
    direction_deg: Annotated[
        Angle, about("Direction in which the casing stands off, from +X. The gap is smallest on the opposite side.")
    ] = 0.0

    @property
    def severity(self) -> float:
        """The offset in m."""
        return self.offset_m

    def surface_harmonics(self, machine: Machine) -> tuple[SurfaceHarmonic, ...]:
        """Return the harmonic of order 1 by which the offset changes the casing's inner surface."""
        return (SurfaceHarmonic(order=1, amplitude_m=self.offset_m, phase_rad=math.radians(self.direction_deg)),)
