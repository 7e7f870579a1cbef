"""A piece that a blade has lost from its tip."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.faults.fault import Fault, LostMass, Severity, missing_blade
from rubgen.machine.mass import blade_mass
from rubgen.machine.quantities import STRICT, BladeNumber, about, real

if TYPE_CHECKING:
    from rubgen.machine.machine import Machine

LostPiece = Annotated[float, real(ge=0, le=1e4)]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class LostTip(Fault):
    """Blade number `blade` has lost the mass `lost_kg` at its tip: damage by a foreign object.

    The mass is taken from the tip as a point mass: from the inertia, from the Coriolis and centrifugal terms, and from
    the pull, so that the disk has the unbalance m r opposite to the blade. Frequencies of the blade rise above those of
    the other blades. Not changed are the stiffness, the tension that the lost mass put into the blade, and the length
    of the blade. At most half of the effective mass of the tip, 1/8 of the blade, can be lost.
    """

    SEVERITY: ClassVar = Severity(column="lost_tip_kg", unit="kg", meaning="mass that a blade has lost at its tip")
    kind: Annotated[Literal["lost-tip"], about("Kind of this fault.")] = "lost-tip"
    lost_kg: Annotated[LostPiece, about("Mass that the tip has lost. At most an eighth of the blade can be lost.")]
    blade: Annotated[BladeNumber, about("Number of the damaged blade.")] = 0

    @property
    def severity(self) -> float:
        """The lost mass in kg."""
        return self.lost_kg

    def problem(self, machine: Machine) -> str | None:
        """Return a problem where the machine does not have the blade, or loses more than 1/8 of it; else None."""
        most = blade_mass(machine.blades) / 8
        if self.lost_kg > most:
            return f"lost_kg = {self.lost_kg:g}: an eighth of a blade, {most:.3g} kg, is the most; lower it"
        return missing_blade(self.blade, machine)

    def lost_masses(self, machine: Machine) -> tuple[LostMass, ...]:
        """Return the lost mass and its blade."""
        return (LostMass(blade=self.blade, kg=self.lost_kg),)
