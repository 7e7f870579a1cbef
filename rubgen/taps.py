"""Taps: the signals that the solver can record at every step of a run, exactly, before any sensor. One class a kind.

O_d is the disk centre.
"""

from typing import Annotated, ClassVar

from pydantic import Field
from pydantic.dataclasses import dataclass

from rubgen.machine.quantities import STRICT, AxialPlace, BladeNumber, Direction
from rubgen.machine.sentences import CHANNEL_NAME


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Tap:
    """A named signal of the true response, in `UNIT`. Each sensor measures one tap."""

    UNIT: ClassVar[str] = ""

    name: Annotated[str, Field(pattern=CHANNEL_NAME)]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class CentreDisplacement(Tap):
    """Displacement of O_d along a direction of the inertial frame (deg from +X), in m."""

    UNIT: ClassVar[str] = "m"
    angle_deg: Direction


@dataclass(frozen=True, kw_only=True, config=STRICT)
class CasingAcceleration(Tap):
    """Radial acceleration of the casing at a polar angle (deg from +X), outward, in m/s2."""

    UNIT: ClassVar[str] = "m/s2"
    angle_deg: Direction


@dataclass(frozen=True, kw_only=True, config=STRICT)
class RingStrain(Tap):
    """Hoop strain at the outer face of the casing at a polar angle (deg from +X), positive in tension."""

    UNIT: ClassVar[str] = "1"
    angle_deg: Direction


@dataclass(frozen=True, kw_only=True, config=STRICT)
class SupportForce(Tap):
    """Force of the disk on its lateral support along a direction of the inertial frame (deg from +X), in N."""

    UNIT: ClassVar[str] = "N"
    angle_deg: Direction


@dataclass(frozen=True, kw_only=True, config=STRICT)
class HousingAcceleration(Tap):
    """Acceleration of the bearing housing along a direction (deg from +X), in m/s2. It belongs to the machine's frame.

    The solver does not record it: `rubgen.measurement.frame` computes it from the taps of the support force.
    """

    UNIT: ClassVar[str] = "m/s2"
    angle_deg: Direction


@dataclass(frozen=True, kw_only=True, config=STRICT)
class ContactForce(Tap):
    """Sum of the normal contact forces, in N. Peaks depend on the time step dt as 1/dt."""

    UNIT: ClassVar[str] = "N"


@dataclass(frozen=True, kw_only=True, config=STRICT)
class ContactTorque(Tap):
    """Torque of the contact forces on the blisk about Z, in N m, negative where contact brakes. Peaks go as 1/dt."""

    UNIT: ClassVar[str] = "N m"


@dataclass(frozen=True, kw_only=True, config=STRICT)
class DriveTorque(Tap):
    """Torque of the drive on the blisk about Z, through the torsion spring and damper of O_d, in N m."""

    UNIT: ClassVar[str] = "N m"


@dataclass(frozen=True, kw_only=True, config=STRICT)
class TipClearance(Tap):
    """Gap on the ray at a polar angle (deg from +X) between the tips and the deformed casing, in m.

    The radius of the tips is interpolated between two blades.
    """

    UNIT: ClassVar[str] = "m"
    angle_deg: Direction


@dataclass(frozen=True, kw_only=True, config=STRICT)
class RootStrain(Tap):
    """Spanwise strain at the root of a blade, mid-chord on the face of the thickness normal, vibration alone."""

    UNIT: ClassVar[str] = "1"
    blade: BladeNumber


@dataclass(frozen=True, kw_only=True, config=STRICT)
class TipTiming(Tap):
    """Passages of the blades under a probe in the casing: events, not samples.

    The probe stands at an angle and at an axial place (m) from the middle of the tips' chords.
    """

    UNIT: ClassVar[str] = "s"
    angle_deg: Direction
    axial_m: AxialPlace = 0.0


DEFAULT_TAPS: tuple[Tap, ...] = (
    CentreDisplacement(name="blisk_x", angle_deg=0),
    CentreDisplacement(name="blisk_y", angle_deg=90),
    *(CasingAcceleration(name=f"casing_acc_{angle}", angle_deg=angle) for angle in (0, 90, 180, 270)),
    SupportForce(name="support_force_x", angle_deg=0),
    SupportForce(name="support_force_y", angle_deg=90),
    ContactForce(name="contact_force"),
    TipClearance(name="tip_clearance_0", angle_deg=0),
    TipClearance(name="tip_clearance_90", angle_deg=90),
)
"""The taps of every run."""


def name_of(value: float) -> str:
    """Write a number as part of a tap's name, where "." and "-" are not allowed: 22.5 becomes 22p5, -3 becomes m3."""
    text = repr(value + 0.0).removesuffix(".0")  # -0.0 becomes 0.0
    return text.replace(".", "p").replace("-", "m").replace("+", "")


def name_of_direction(angle_deg: float) -> str:
    """Write a direction of the inertial frame as part of a tap's name: 0 deg is x, 90 deg y, others as in `name_of`."""
    return {0.0: "x", 90.0: "y"}.get(angle_deg, name_of(angle_deg))
