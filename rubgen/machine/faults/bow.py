"""A bent shaft."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.faults.fault import Fault, HarmonicLoad, Ramp, Severity
from rubgen.machine.quantities import STRICT, Angle, Usual, about, real

if TYPE_CHECKING:
    from rubgen.machine.machine import Machine

Moment = Annotated[float, real(ge=0, le=1e5)]
BowSize = Annotated[
    float,
    real(ge=0, le=0.1, usual=Usual(0, 1e-3, "shafts are bent by 1e-6 to 5e-4 m", (("mm", 1e-3), ("um", 1e-6)), "m")),
]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Bow(Fault):
    """A residual bow of the shaft: without any load the disk centre is `bow_m` off the axis, and turns with the shaft.

    The lateral springs k act on the displacement beyond the bow, k (u - b e^(i theta)). The bow is therefore a force k
    b that is constant in the turning frame, at `angle_deg` from blade 0 in the sense of rotation (Nicholas, Gunter,
    Allaire 1976). k is the mean lateral stiffness of the disk support. At slow roll the disk centre moves on a circle
    of radius b. At the critical speed a bow of U / m against the unbalance U of a mass m cancels it.

    With `growth_s` the bow is thermal: it grows linearly from 0, from `start_s` of the record on. The growth is
    prescribed; it does not follow from the heat of a rub.
    """

    SEVERITY: ClassVar = Severity(column="bow_m", unit="m", meaning="residual bow of the shaft at the disk centre")
    kind: Annotated[Literal["bow"], about("Kind of this fault.")] = "bow"
    bow_m: Annotated[BowSize, about("How far the disk centre stands off the axis without load.")]
    angle_deg: Annotated[
        Angle,
        about(
            "Angle of the bow from blade 0, in the sense of rotation. Opposite to the unbalance it "
            "cancels a part of it."
        ),
    ] = 0.0
    start_s: Annotated[Moment, about("Time of the record at which a thermal bow begins to grow.")] = 0.0
    growth_s: Annotated[
        Moment | None,
        about(
            "Time in which the bow grows from 0. Give it for a thermal bow; without it the bow is there from the start."
        ),
    ] = None

    @property
    def severity(self) -> float:
        """The bow in m."""
        return self.bow_m

    def loads(self, machine: Machine, speed: float) -> tuple[HarmonicLoad, ...]:
        """Return the force k b of the lateral springs, constant in the turning frame."""
        force = machine.disk_support.lateral_stiffness_n_per_m * self.bow_m
        turned = cmath.rect(force, math.radians(self.angle_deg))
        ramp = None if self.growth_s is None else Ramp(start_s=self.start_s, duration_s=self.growth_s)
        return (HarmonicLoad.rotating(turned, ramp, of_springs=True),)
