"""Force washer in the support of the disk."""

from rubgen.scenario.taps import SupportForce
from rubgen.sensors.kind import Description, Kind, along, label

KIND = Kind(
    describe=lambda sensor: Description(quantity="force", axis=along(sensor.angle_deg), location="disk support"),
    tap=lambda sensor: SupportForce(name=f"support_force_{label(sensor.angle_deg)}", angle_deg=sensor.angle_deg),
)
