"""The contact force, recorded as if a probe could: it is the cause of everything else."""

from rubgen.scenario.taps import ContactForce
from rubgen.sensors.kind import Description, Kind

KIND = Kind(
    describe=lambda _sensor: Description(quantity="contact force", axis="normal", location="all blade tips"),
    tap=lambda _sensor: ContactForce(name="contact_force"),
)
