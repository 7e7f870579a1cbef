"""Proximity probe: displacement of the disk centre, and the profile of the shaft that it cannot tell from it."""

from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic.dataclasses import dataclass

from rubgen.arrays import FloatArray
from rubgen.machine.quantities import STRICT, Bias, Direction, Sensitivity, about
from rubgen.sensors.sensor import Description, RunoutOrder, SampledSensor, axis_of, runout
from rubgen.taps import CentreDisplacement, name_of_direction


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Proximity(SampledSensor):
    """Displacement of the disk centre along a direction. In V it is the gap voltage, `bias_v` at rest."""

    UNITS: ClassVar[dict[str, float]] = {"m": 1.0, "mm": 1e3, "um": 1e6, "V": 0.0}
    RANGE: ClassVar[tuple[float, float]] = (-2e-3, 2e-3)
    kind: Annotated[Literal["proximity"], about("Kind of this sensor.")] = "proximity"
    angle_deg: Annotated[
        Direction, about("Direction in which the probe measures, from +X. Two probes at right angles show the orbit.")
    ]
    sensitivity_v_per_m: Annotated[
        Sensitivity,
        about('Change of the gap voltage with the displacement. 7,874 is 200 mV/mil. It counts where unit is "V".'),
    ] = 7874.0
    bias_v: Annotated[Bias, about('Gap voltage at rest. It counts where unit is "V".')] = -10.0

    @property
    def tap(self) -> CentreDisplacement:
        return CentreDisplacement(name=f"blisk_{name_of_direction(self.angle_deg)}", angle_deg=self.angle_deg)

    @property
    def description(self) -> Description:
        quantity = "gap voltage" if self.unit == "V" else "displacement"
        axis = axis_of(self.angle_deg)
        return Description(quantity=quantity, axis=axis, location="disk centre")

    @property
    def scale(self) -> tuple[float, float]:
        """Factor and zero of the reading: reading = zero + factor x. In V it is the gap voltage, bias + sensitivity x.

        The voltage rises as the shaft comes nearer. With the default bias it is negative.
        """
        return (self.sensitivity_v_per_m, self.bias_v) if self.unit == "V" else super().scale

    def disturbed(self, signal: FloatArray, angle: FloatArray, shaft: tuple[RunoutOrder, ...]) -> FloatArray:
        """Add the shaft's profile to `signal`, m.

        A probe at angle phi sees the profile at phi - theta; high spots are nearer.
        """
        return signal + runout(np.deg2rad(self.angle_deg) - angle, shaft) if shaft else signal
