"""Every kind of sensor, one line each."""

from typing import Annotated, get_args

from pydantic import Field

from rubgen.sensors.kinds.accelerometer import Accelerometer
from rubgen.sensors.kinds.blade_strain import BladeStrain
from rubgen.sensors.kinds.blade_tip_timing import TimingProbe
from rubgen.sensors.kinds.casing_strain import CasingStrain
from rubgen.sensors.kinds.contact_force import ContactForceSensor
from rubgen.sensors.kinds.housing_accelerometer import HousingAccelerometer
from rubgen.sensors.kinds.once_per_rev import OncePerRev
from rubgen.sensors.kinds.proximity import Proximity
from rubgen.sensors.kinds.support_force import SupportForceSensor
from rubgen.sensors.kinds.tip_clearance import ClearanceProbe
from rubgen.sensors.kinds.torque import Torque

AnySensor = Annotated[
    Proximity
    | Accelerometer
    | HousingAccelerometer
    | BladeStrain
    | CasingStrain
    | SupportForceSensor
    | ContactForceSensor
    | Torque
    | ClearanceProbe
    | TimingProbe
    | OncePerRev,
    Field(discriminator="kind"),
]
SENSOR_KINDS: tuple[str, ...] = tuple(sensor.kind for sensor in get_args(get_args(AnySensor)[0]))
"""The names of the kinds in a sensor set."""
