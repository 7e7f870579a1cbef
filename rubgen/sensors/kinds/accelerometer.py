"""Accelerometer on the casing."""

from typing import Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.quantities import STRICT, Direction, about
from rubgen.sensors.sensor import Description, SampledSensor
from rubgen.taps import CasingAcceleration, name_of
from rubgen.units import STANDARD_GRAVITY


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Accelerometer(SampledSensor):
    """Radial acceleration of the casing, positive outward."""

    UNITS: ClassVar[dict[str, float]] = {"m/s2": 1.0, "g": 1 / STANDARD_GRAVITY}
    RANGE: ClassVar[tuple[float, float]] = (-5e4, 5e4)
    kind: Annotated[Literal["accelerometer"], about("Kind of this sensor.")] = "accelerometer"
    angle_deg: Annotated[Direction, about("Place on the casing, from +X. Near a narrow place it is near the rub.")]

    @property
    def tap(self) -> CasingAcceleration:
        return CasingAcceleration(name=f"casing_acc_{name_of(self.angle_deg)}", angle_deg=self.angle_deg)

    @property
    def description(self) -> Description:
        place = f"casing at {self.angle_deg:g} deg"
        return Description(quantity="acceleration", axis="radial outward", location=place)
