"""Whirl and whip in oil-lubricated bearings."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.faults.fault import Fault, Severity
from rubgen.machine.mass import blisk_mass
from rubgen.machine.quantities import STRICT, Length, Usual, about, real
from rubgen.machine.support_laws.whirling_film import WhirlingFilm

if TYPE_CHECKING:
    from rubgen.machine.machine import Machine
    from rubgen.machine.support_laws.law import SupportLaw

SwirlRatio = Annotated[float, real(gt=0, lt=1, usual=Usual(0.3, 0.5, "films have 0.42 to 0.48"))]
FilmShare = Annotated[float, real(gt=0, le=1)]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class OilWhirl(Fault):
    """Unloaded journal bearings, whose oil turns with the journal and drives the rotor around.

    The dampers of the support act against oil that turns at `swirl_ratio` times the speed. The centred film has the
    share `film_stiffness` of the support's stiffness. Both change with the eccentricity |u| of the disk centre by q =
    1 / (1 + |u|^2 / film_scale_m^2): the oil turns slower, and the film stiffens up to the support without the fault.
    With k_f = film_stiffness k the rotor whirls by itself above Omega = sqrt(k_f / m) / swirl_ratio (Muszynska 1986).
    """

    SEVERITY: ClassVar = Severity(
        column="oil_swirl_ratio", unit="1", meaning="mean speed of the oil in the centred film over the rotor's"
    )
    kind: Annotated[Literal["oil-whirl"], about("Kind of this fault.")] = "oil-whirl"
    swirl_ratio: Annotated[
        SwirlRatio,
        about("Mean speed of the oil in the centred film over the speed of the rotor. Films have 0.42 to 0.48."),
    ] = 0.47
    film_stiffness: Annotated[
        FilmShare,
        about(
            "Stiffness of the centred film over that of the support. A smaller one starts the whirl at a lower speed."
        ),
    ] = 0.1
    film_scale_m: Annotated[
        Length, about("Eccentricity at which the oil has half of its mean speed. A larger one makes a larger whirl.")
    ] = 1e-3

    @property
    def severity(self) -> float:
        """The swirl ratio: mean speed of the oil in the centred film over the speed of the rotor."""
        return self.swirl_ratio

    def problem(self, machine: Machine) -> str | None:
        """Return a problem for a machine without lateral damping, through which the oil acts; else None."""
        if machine.damping.lateral > 0:
            return None
        return "damping.lateral = 0, and the oil acts through that damper; give it a ratio above 0"

    def support_laws(self, machine: Machine, speed: float) -> tuple[SupportLaw, ...]:
        """Return one law, the oil film at `speed` (rad/s). It acts in addition to springs and dampers of the support.

        The swirl is c `swirl_ratio` `speed`, with the damper c = 2 zeta sqrt(k m) of the blisk as a rigid mass. The
        film lacks (1 - `film_stiffness`) k at its centre. k is the support's lateral stiffness, the mean of X and Y.
        """
        stiffness = machine.disk_support.lateral_stiffness_n_per_m
        damper = 2 * machine.damping.lateral * math.sqrt(stiffness * blisk_mass(machine))
        return (
            WhirlingFilm(
                swirl_n_per_m=damper * self.swirl_ratio * speed,
                soft_n_per_m=(1 - self.film_stiffness) * stiffness,
                scale_m=self.film_scale_m,
            ),
        )
