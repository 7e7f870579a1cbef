"""Torque on the blisk: of its drive, as measured by a torque flange, or of the contact, which no sensor measures."""

from typing import Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.quantities import STRICT, about
from rubgen.sensors.sensor import Description, SampledSensor
from rubgen.taps import ContactTorque, DriveTorque


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Torque(SampledSensor):
    """Torque on the blisk about the axis: of the drive, or (what no sensor measures) of the contact."""

    UNITS: ClassVar[dict[str, float]] = {"N m": 1.0, "kN m": 1e-3}
    RANGE: ClassVar[tuple[float, float]] = (-2e4, 2e4)
    kind: Annotated[Literal["torque"], about("Kind of this sensor.")] = "torque"
    of: Annotated[
        Literal["drive", "contact"],
        about(
            "Which torque: the drive's, which a torque flange measures, or that of the contact, which "
            "no sensor measures."
        ),
    ] = "drive"

    @property
    def tap(self) -> DriveTorque | ContactTorque:
        return DriveTorque(name="drive_torque") if self.of == "drive" else ContactTorque(name="contact_torque")

    @property
    def description(self) -> Description:
        place = "drive shaft" if self.of == "drive" else "all blade tips"
        return Description(quantity=f"{self.of} torque", axis="rotation", location=place)
