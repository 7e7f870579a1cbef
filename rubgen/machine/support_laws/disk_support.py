"""The support of the disk centre, and the registry of laws: keys of `DiskSupport`, and laws of faults."""

from typing import Annotated

from pydantic.dataclasses import dataclass

from rubgen.machine.quantities import STRICT, Anisotropy, Stiffness, about
from rubgen.machine.registered import given, registered
from rubgen.machine.support_laws.breathing_spring import BreathingSpring
from rubgen.machine.support_laws.law import SupportLaw
from rubgen.machine.support_laws.loose_spring import LooseSpring
from rubgen.machine.support_laws.squeeze_film import SqueezeFilm
from rubgen.machine.support_laws.whirling_film import WhirlingFilm


@dataclass(frozen=True, kw_only=True, config=STRICT)
class DiskSupport:
    """Springs between the disk centre and the inertial frame, and laws that act beside them.

    `lateral_stiffness_n_per_m` is the mean of X and Y. `lateral_stiffness_anisotropy` is (k_X - k_Y) / (k_X + k_Y), and
    `lateral_damping_anisotropy` is the same ratio of the dampers beside them. Tilt springs and dampers are isotropic.
    """

    lateral_stiffness_n_per_m: Annotated[
        Stiffness,
        about(
            "Lateral stiffness of the shaft and bearings at the disk centre, mean of X and Y. It "
            "decides the critical speed."
        ),
    ]
    axial_stiffness_n_per_m: Annotated[Stiffness, about("Axial stiffness at the disk centre.")]
    tilt_stiffness_nm_per_rad: Annotated[Stiffness, about("Stiffness against tilting of the disk about X and Y.")]
    torsion_stiffness_nm_per_rad: Annotated[
        Stiffness, about("Stiffness against turning of the disk against its drive.")
    ]
    lateral_stiffness_anisotropy: Annotated[
        Anisotropy,
        about(
            "(k_X - k_Y) / (k_X + k_Y) of the lateral springs. Another value than 0 splits the "
            "critical speed in two and makes backward whirl possible."
        ),
    ] = 0.0
    lateral_damping_anisotropy: Annotated[Anisotropy, about("The same ratio of the lateral dampers.")] = 0.0
    squeeze_film: Annotated[
        SqueezeFilm | None,
        about("A squeeze film damper beside the lateral springs. Without it the damping ratios alone damp the disk."),
    ] = None

    @property
    def laws(self) -> tuple[SupportLaw, ...]:
        """The laws of the support in the machine file, in the order of the keys."""
        return tuple(given(self, SupportLaw).values())


SUPPORT_LAWS: dict[str, type[SupportLaw]] = registered(DiskSupport, SupportLaw)
"""Every law that is a key of `DiskSupport`, by its key."""
LAWS: tuple[type[SupportLaw], ...] = (*SUPPORT_LAWS.values(), LooseSpring, BreathingSpring, WhirlingFilm)
"""Every law, those of faults last; kernels know a law by its place."""
