"""A crack across the shaft that breathes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.faults.fault import Fault, Severity
from rubgen.machine.mass import blisk_mass
from rubgen.machine.quantities import PERCENT, STRICT, Angle, Usual, about, real
from rubgen.machine.support_laws.breathing_spring import BreathingSpring

if TYPE_CHECKING:
    from rubgen.machine.machine import Machine
    from rubgen.machine.support_laws.law import SupportLaw

CrackShare = Annotated[
    float, real(gt=0, le=0.5, usual=Usual(0, 0.4, "a crack of half the diameter takes about 0.3", PERCENT))
]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Crack(Fault):
    """A transverse crack that the weight of the rotor opens and closes once a turn.

    Along the crack's own direction, `angle_deg` from blade 0 in the sense of rotation, the shaft loses the share
    `crack_loss` of the lateral stiffness where the crack is open. It is open where it points down, closed where it
    points up, and half open between: (1 + cos) / 2 of the angle from the direction of gravity (Mayes and Davies 1984).
    The crack is opened by the weight alone, so the weight's sag must exceed the vibration (Gasch 1993).
    """

    SEVERITY: ClassVar = Severity(
        column="crack_loss", unit="1", meaning="share of the lateral stiffness that the open crack takes"
    )
    kind: Annotated[Literal["crack"], about("Kind of this fault.")] = "crack"
    crack_loss: Annotated[
        CrackShare,
        about(
            "Share of the lateral stiffness that the open crack takes. A crack of half the diameter takes about 0.3."
        ),
    ]
    angle_deg: Annotated[Angle, about("Direction of the crack from blade 0, in the sense of rotation.")] = 0.0

    @property
    def severity(self) -> float:
        """The share of the lateral stiffness that the open crack takes."""
        return self.crack_loss

    def problem(self, machine: Machine) -> str | None:
        """Return a problem for a machine without gravity, where nothing opens and closes the crack; else None."""
        if machine.gravity_m_per_s2 > 0:
            return None
        return "gravity_m_per_s2 = 0, and a crack breathes under the weight; give the machine gravity_m_per_s2 = 9.81"

    def doubt(self, machine: Machine, speed: float) -> str | None:
        """Return a doubt where the unbalance moves the disk by more than its weight does; else None.

        A real crack then does not breathe with the weight. `speed` is in rad/s. Both motions are estimated for a rigid
        blisk on its lateral spring and damper, with `unbalance_kg_m` as the only unbalance.
        """
        mass, stiffness = blisk_mass(machine), machine.disk_support.lateral_stiffness_n_per_m
        drag = 2 * machine.damping.lateral * math.sqrt(stiffness * mass)
        sag = mass * machine.gravity_m_per_s2 / stiffness
        whirl = machine.unbalance_kg_m * speed**2 / abs(complex(stiffness - mass * speed**2, drag * speed))
        if whirl <= sag:
            return None
        return (
            f"crack_loss = {self.crack_loss:g}: the unbalance moves the disk by {1e6 * whirl:.3g} um, its sag is "
            f"{1e6 * sag:.3g} um: a real crack would not breathe with the weight; lower unbalance_kg_m"
        )

    def support_laws(self, machine: Machine, speed: float) -> tuple[SupportLaw, ...]:
        """Return the stiffness lost by the crack, as a spring law with a force along the displacement."""
        stiffness = machine.disk_support.lateral_stiffness_n_per_m
        return (BreathingSpring(lost_n_per_m=self.crack_loss * stiffness, direction_rad=math.radians(self.angle_deg)),)
