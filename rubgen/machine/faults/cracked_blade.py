"""A blade with a crack."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.faults.fault import Fault, Severity, missing_blade
from rubgen.machine.quantities import STRICT, BladeNumber, about, real

if TYPE_CHECKING:
    from rubgen.machine.machine import Machine

StiffnessLoss = Annotated[float, real(ge=0, le=0.9)]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class CrackedBlade(Fault):
    """Blade number `blade` has lost the share `stiffness_loss` of its elastic stiffness, equally along its length.

    The crack stays open: in a turning blade the centrifugal pull holds it open. The frequencies of the blade at rest
    fall by about sqrt(1 - loss), below those of the other blades, and its tip grows more. Its mass is the same. A run
    with a new loss needs a new reduction of the machine, which takes about a second.
    """

    SEVERITY: ClassVar = Severity(
        column="blade_stiffness_loss", unit="1", meaning="share of its stiffness that a cracked blade has lost"
    )
    kind: Annotated[Literal["cracked-blade"], about("Kind of this fault.")] = "cracked-blade"
    stiffness_loss: Annotated[
        StiffnessLoss,
        about(
            "Share of the blade's stiffness that the crack takes. The frequency of the blade falls by about half of it."
        ),
    ]
    blade: Annotated[BladeNumber, about("Number of the cracked blade.")] = 0

    @property
    def severity(self) -> float:
        """The share of the blade's stiffness that is lost."""
        return self.stiffness_loss

    def problem(self, machine: Machine) -> str | None:
        """Return a problem where the machine does not have the cracked blade; else None."""
        return missing_blade(self.blade, machine)

    def altered(self, machine: Machine) -> Machine:
        """Return the machine with the stiffness of the cracked blade reduced."""
        from rubgen.machine.machine import Mistuning  # the machine imports the registry of faults

        deviations = list(machine.blades.stiffness_deviations)
        deviations[self.blade] = (1 + deviations[self.blade]) * (1 - self.stiffness_loss) - 1
        return replace(machine, blades=replace(machine.blades, mistuning=Mistuning(pattern=tuple(deviations))))
