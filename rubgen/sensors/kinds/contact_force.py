"""The contact force, recorded although no probe can measure it: it is the cause of everything else."""

from typing import Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.quantities import STRICT, about
from rubgen.sensors.sensor import Description, SampledSensor
from rubgen.taps import ContactForce


@dataclass(frozen=True, kw_only=True, config=STRICT)
class ContactForceSensor(SampledSensor):
    """The sum of the normal contact forces, which no real probe measures."""

    UNITS: ClassVar[dict[str, float]] = {"N": 1.0, "kN": 1e-3}
    RANGE: ClassVar[tuple[float, float]] = (-1e5, 1e5)
    kind: Annotated[
        Literal["contact_force"],
        about("Kind of this sensor. No real sensor measures it; it is the truth for learning."),
    ] = "contact_force"

    @property
    def tap(self) -> ContactForce:
        return ContactForce(name="contact_force")

    @property
    def description(self) -> Description:
        return Description(quantity="contact force", axis="normal", location="all blade tips")
