"""A casing whose centre is not on the axis of rotation."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.faults.fault import Fault, Severity, SurfaceHarmonic
from rubgen.machine.quantities import STRICT, Angle, real

if TYPE_CHECKING:
    from rubgen.machine.machine import Machine

Offset = Annotated[float, real(ge=0, le=0.1)]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class CasingOffCentre(Fault):
    """The casing stands `offset_m` off the axis of rotation, towards `direction_deg` from +X.

    Its inner surface gets the order r += e cos(theta - direction), exact to e^2 / (2 r). The gap is narrowest on the
    opposite side, so the blades rub on one side. `clearance_m` is the smallest gap of the centred casing.
    """

    SEVERITY: ClassVar = Severity(
        column="casing_offset_m", unit="m", meaning="distance of the casing's centre from the axis of rotation"
    )
    kind: Literal["casing-off-centre"] = "casing-off-centre"
    offset_m: Offset
    direction_deg: Angle = 0.0

    @property
    def severity(self) -> float:
        """The offset in m."""
        return self.offset_m

    def surface_harmonics(self, machine: Machine) -> tuple[SurfaceHarmonic, ...]:
        """Return the harmonic of order 1 by which the offset changes the casing's inner surface."""
        return (SurfaceHarmonic(order=1, amplitude_m=self.offset_m, phase_rad=math.radians(self.direction_deg)),)
