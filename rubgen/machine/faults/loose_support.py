"""A support that is loose on one side."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.faults.fault import Fault, Severity
from rubgen.machine.quantities import PERCENT, STRICT, Angle, Usual, about, real
from rubgen.machine.support_laws.loose_spring import LooseSpring

if TYPE_CHECKING:
    from rubgen.machine.machine import Machine
    from rubgen.machine.support_laws.law import SupportLaw

LostShare = Annotated[float, real(gt=0, le=0.99, usual=Usual(0.01, 0.99, "less is hardly felt", PERCENT))]
Gap = Annotated[float, real(ge=-0.01, le=0.1)]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class LooseSupport(Fault):
    """A pedestal whose bolts have come loose: where the rotor lifts it, the support is softer.

    Along the direction of the lift, `direction_deg` from +X, the lateral spring loses the share `lost_stiffness` of its
    stiffness beyond a displacement of `gap_m` of the disk centre. The stiffness is bilinear (Goldman and Muszynska
    1994). The other direction, the other side and the dampers are as without the fault.
    """

    SEVERITY: ClassVar = Severity(
        column="lost_stiffness", unit="1", meaning="share of the support's stiffness that is lost where it is loose"
    )
    kind: Annotated[Literal["loose-support"], about("Kind of this fault.")] = "loose-support"
    lost_stiffness: Annotated[
        LostShare, about("Share of the lateral stiffness that is lost where the support is lifted.")
    ]
    gap_m: Annotated[Gap, about("Displacement of the disk centre from which on the stiffness is lost.")] = 0.0
    direction_deg: Annotated[
        Angle, about("Direction of that displacement from +X. 90 is upwards, against gravity.")
    ] = 90.0

    @property
    def severity(self) -> float:
        """The share of the stiffness that is lost where the support is loose."""
        return self.lost_stiffness

    def support_laws(self, machine: Machine, speed: float) -> tuple[SupportLaw, ...]:
        """Return one law: a force in the direction of the lift that cancels the lost stiffness beyond the gap.

        `lost_stiffness` is a share of `lateral_stiffness_n_per_m`, the mean of X and Y. The speed has no influence.
        """
        stiffness = machine.disk_support.lateral_stiffness_n_per_m
        return (
            LooseSpring(
                lost_n_per_m=self.lost_stiffness * stiffness,
                gap_m=self.gap_m,
                direction_rad=math.radians(self.direction_deg),
            ),
        )
