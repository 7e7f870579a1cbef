"""Torque on the blisk: of its drive, as a torque flange sees it, or of the contact, which no sensor sees."""

from rubgen.scenario.sensors import Torque
from rubgen.scenario.taps import ContactTorque, DriveTorque, Tap
from rubgen.sensors.kind import Description, Kind


def tap(sensor: Torque) -> Tap:
    """The drive's or the contact's."""
    return DriveTorque(name="drive_torque") if sensor.of == "drive" else ContactTorque(name="contact_torque")


KIND = Kind(
    describe=lambda sensor: Description(
        quantity=f"{sensor.of} torque",
        axis="rotation",
        location="drive shaft" if sensor.of == "drive" else "all blade tips",
    ),
    tap=tap,
)
