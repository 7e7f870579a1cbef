"""Accelerometer on the bearing housing."""

from typing import Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.quantities import STRICT, Direction, about
from rubgen.sensors.sensor import Description, SampledSensor, axis_of
from rubgen.taps import HousingAcceleration, name_of_direction
from rubgen.units import STANDARD_GRAVITY


@dataclass(frozen=True, kw_only=True, config=STRICT)
class HousingAccelerometer(SampledSensor):
    """Acceleration of the bearing housing along a direction across the axis. The machine must have a frame.

    The axial direction cannot be measured: the frame's modes have no axial motion.
    """

    UNITS: ClassVar[dict[str, float]] = {"m/s2": 1.0, "g": 1 / STANDARD_GRAVITY}
    RANGE: ClassVar[tuple[float, float]] = (-5e3, 5e3)
    kind: Annotated[Literal["housing_accelerometer"], about("Kind of this sensor.")] = "housing_accelerometer"
    angle_deg: Annotated[Direction, about("Direction in which it measures, from +X. The machine must have a frame.")]

    @property
    def tap(self) -> HousingAcceleration:
        return HousingAcceleration(name=f"housing_acc_{name_of_direction(self.angle_deg)}", angle_deg=self.angle_deg)

    @property
    def description(self) -> Description:
        return Description(quantity="acceleration", axis=axis_of(self.angle_deg), location="bearing housing")
