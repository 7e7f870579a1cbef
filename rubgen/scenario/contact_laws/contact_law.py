"""What happens where a blade touches the casing, and the registry of its laws: one key of `ContactLaw` each."""

from typing import Annotated, Literal, Self

from pydantic import model_validator
from pydantic.dataclasses import dataclass

from rubgen.machine.quantities import STRICT, Friction, Length, LinerBins, Restitution, Switch, WearRate, about
from rubgen.machine.registered import given, registered
from rubgen.scenario.contact_laws.law import NormalLaw
from rubgen.scenario.contact_laws.rigid import Rigid


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Liner:
    """An abradable lining of the casing that wears at the contact (Archard 1953): volume = wear force sliding.

    `wear_m2_per_n` is the volume worn for each newton and metre of sliding. `width_m` is the axial width of the track,
    over which the depth is constant. `bins` is the number of equal steps of polar angle of the depth. Below
    `thickness_m` the casing does not wear.
    """

    thickness_m: Annotated[
        Length, about("Thickness of the lining. Where it is worn through, the casing does not wear.")
    ]
    wear_m2_per_n: Annotated[
        WearRate, about("Volume worn for each newton and metre of sliding. Linings have 1e-14 to 1e-9 m2/N.")
    ]
    width_m: Annotated[Length, about("Axial width of the track that wears. A wider one wears less deep.")]
    bins: Annotated[
        LinerBins,
        about("Number of equal steps of the angle in which the depth is kept. Raise it for short contact zones."),
    ] = 360


@dataclass(frozen=True, kw_only=True, config=STRICT)
class ContactLaw:
    """Unilateral contact with sliding Coulomb friction. It is rigid, and restitution 0 is a plastic impact.

    With `half_thickness` contact acts on the casing's inner surface, half the ring's thickness inside its centre line.
    Friction then also turns the ring's cross-section, and the surface moves with that rotation. `surface` "chords"
    joins the casing's nodes by straight lines instead of the smooth curve through them. A `liner` wears where blades
    touch.
    """

    friction: Annotated[
        Friction,
        about(
            "Coulomb coefficient of sliding friction. More drives blades along the casing and can make them chatter."
        ),
    ] = 0.0
    restitution: Annotated[
        Restitution, about("Speed after an impact over the speed before it. 0 is a plastic impact, 1 loses no energy.")
    ] = 0.0
    half_thickness: Annotated[
        Switch,
        about(
            "Whether contact acts on the inner surface of the ring instead of its centre line, so "
            "that friction also turns the ring."
        ),
    ] = False
    surface: Annotated[
        Literal["smooth", "chords"],
        about('The casing\'s inner surface between its nodes. "chords" is for the comparison with the paper only.'),
    ] = "smooth"
    liner: Annotated[
        Liner | None, about("An abradable lining that wears where blades touch. Without it the casing does not wear.")
    ] = None

    @model_validator(mode="after")
    def _one_normal_law(self) -> Self:
        keys = [*given(self, NormalLaw), *(["restitution"] if self.restitution else [])]
        if len(keys) > 1:
            raise ValueError(f"{' and '.join(keys)}: only one of them can make the normal force; remove the others")
        return self

    @property
    def normal(self) -> NormalLaw:
        """The law of the normal force: the law that the contact has a key for, or rigid contact without such a key."""
        laws: list[NormalLaw] = [*given(self, NormalLaw).values(), Rigid()]
        return laws[0]


NORMAL_LAWS: tuple[type[NormalLaw], ...] = (Rigid, *registered(ContactLaw, NormalLaw).values())
"""Every law of the normal force; kernels know a law by its place."""
