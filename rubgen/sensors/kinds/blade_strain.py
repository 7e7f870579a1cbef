"""Strain gauge at the root of a blade."""

from typing import Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.quantities import STRICT, BladeNumber, about
from rubgen.sensors.sensor import Description, SampledSensor
from rubgen.taps import RootStrain


@dataclass(frozen=True, kw_only=True, config=STRICT)
class BladeStrain(SampledSensor):
    """Spanwise strain at a blade's root."""

    UNITS: ClassVar[dict[str, float]] = {"1": 1.0, "um/m": 1e6}
    RANGE: ClassVar[tuple[float, float]] = (-5e-3, 5e-3)
    kind: Annotated[Literal["blade_strain"], about("Kind of this sensor.")] = "blade_strain"
    blade: Annotated[BladeNumber, about("Number of the blade with the gauge at its root.")]

    @property
    def tap(self) -> RootStrain:
        return RootStrain(name=f"root_strain_{self.blade}", blade=self.blade)

    @property
    def description(self) -> Description:
        place = f"root of blade {self.blade}"
        return Description(quantity="blade strain", axis="spanwise", location=place)
