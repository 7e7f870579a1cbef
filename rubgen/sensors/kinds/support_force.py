"""Force washer in the support of the disk."""

from typing import Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.quantities import STRICT, Direction, about
from rubgen.sensors.sensor import Description, SampledSensor, axis_of
from rubgen.taps import SupportForce, name_of_direction


@dataclass(frozen=True, kw_only=True, config=STRICT)
class SupportForceSensor(SampledSensor):
    """Dynamic force of the disk on its support along a direction."""

    UNITS: ClassVar[dict[str, float]] = {"N": 1.0, "kN": 1e-3}
    RANGE: ClassVar[tuple[float, float]] = (-2.5e5, 2.5e5)
    kind: Annotated[Literal["support_force"], about("Kind of this sensor.")] = "support_force"
    angle_deg: Annotated[Direction, about("Direction in which it measures, from +X.")]

    @property
    def tap(self) -> SupportForce:
        return SupportForce(name=f"support_force_{name_of_direction(self.angle_deg)}", angle_deg=self.angle_deg)

    @property
    def description(self) -> Description:
        axis = axis_of(self.angle_deg)
        return Description(quantity="force", axis=axis, location="disk support")
