"""Probe of the gap between the blade tips and the casing."""

from typing import Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.quantities import STRICT, Direction, about
from rubgen.sensors.sensor import Description, SampledSensor
from rubgen.taps import TipClearance, name_of


@dataclass(frozen=True, kw_only=True, config=STRICT)
class ClearanceProbe(SampledSensor):
    """Gap between the blade tips and the casing."""

    UNITS: ClassVar[dict[str, float]] = {"m": 1.0, "mm": 1e3, "um": 1e6}
    RANGE: ClassVar[tuple[float, float]] = (-1e-3, 1.2e-2)
    kind: Annotated[Literal["tip_clearance"], about("Kind of this sensor.")] = "tip_clearance"
    angle_deg: Annotated[Direction, about("Place on the casing, from +X.")]

    @property
    def tap(self) -> TipClearance:
        return TipClearance(name=f"tip_clearance_{name_of(self.angle_deg)}", angle_deg=self.angle_deg)

    @property
    def description(self) -> Description:
        place = f"casing at {self.angle_deg:g} deg"
        return Description(quantity="gap", axis="radial", location=place)
