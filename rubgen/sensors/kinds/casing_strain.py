"""Strain gauge on the outer face of the casing, around the ring."""

from typing import Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.quantities import STRICT, Direction, about
from rubgen.sensors.sensor import Description, SampledSensor
from rubgen.taps import RingStrain, name_of


@dataclass(frozen=True, kw_only=True, config=STRICT)
class CasingStrain(SampledSensor):
    """Hoop strain at the outer face of the casing."""

    UNITS: ClassVar[dict[str, float]] = {"1": 1.0, "um/m": 1e6}
    RANGE: ClassVar[tuple[float, float]] = (-5e-3, 5e-3)
    kind: Annotated[Literal["casing_strain"], about("Kind of this sensor.")] = "casing_strain"
    angle_deg: Annotated[Direction, about("Place on the casing, from +X.")]

    @property
    def tap(self) -> RingStrain:
        return RingStrain(name=f"ring_strain_{name_of(self.angle_deg)}", angle_deg=self.angle_deg)

    @property
    def description(self) -> Description:
        place = f"casing at {self.angle_deg:g} deg, outer face"
        return Description(quantity="casing strain", axis="hoop", location=place)
