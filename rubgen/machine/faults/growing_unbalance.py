"""An unbalance that grows within the record."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.faults.fault import Fault, HarmonicLoad, Ramp, Severity
from rubgen.machine.quantities import STRICT, Angle, UnbalanceSize, about, real

if TYPE_CHECKING:
    from rubgen.machine.machine import Machine

Moment = Annotated[float, real(ge=0, le=1e5)]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class GrowingUnbalance(Fault):
    """An unbalance on the disk, beside the machine's own, that is 0 until `start_s` of the record.

    It then grows linearly over `growth_s` to `kg_m` at `angle_deg` from blade 0, in the sense of rotation: deposits, or
    with 0 a part that is lost at once (over one turn). The force is U Omega^2 outward. At a changing speed the force
    along the rotation, U Omega', is left out.
    """

    SEVERITY: ClassVar = Severity(
        column="growing_unbalance_kg_m", unit="kg m", meaning="unbalance that grows within the record, at its end"
    )
    kind: Annotated[Literal["growing-unbalance"], about("Kind of this fault.")] = "growing-unbalance"
    kg_m: Annotated[UnbalanceSize, about("Mass times radius of the unbalance that comes in addition.")]
    angle_deg: Annotated[Angle, about("Angle of this unbalance from blade 0, in the sense of rotation.")] = 0.0
    start_s: Annotated[
        Moment, about("Time of the record at which it begins to grow. Set it within the record to see the change.")
    ] = 0.0
    growth_s: Annotated[Moment, about("Time in which it grows to its full size. 0 is a lost part.")] = 0.0

    @property
    def severity(self) -> float:
        """The unbalance after its growth, in kg m."""
        return self.kg_m

    def loads(self, machine: Machine, speed: float) -> tuple[HarmonicLoad, ...]:
        """Return the force U Omega^2 with its growth. It is constant in the turning frame."""
        force = cmath.rect(self.kg_m * speed**2, math.radians(self.angle_deg))
        return (HarmonicLoad.rotating(force, Ramp(start_s=self.start_s, duration_s=self.growth_s)),)
