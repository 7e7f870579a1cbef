"""Probe of blade tip timing: the passage of each blade."""

from typing import Annotated, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.quantities import STRICT, AxialPlace, ClockOffset, Direction, Jitter, MissedShare, RateOrNone, about
from rubgen.sensors.sensor import Sensor
from rubgen.taps import TipTiming


@dataclass(frozen=True, kw_only=True, config=STRICT)
class TimingProbe(Sensor):
    """Arrival times of the blades at an angle on the casing, `axial_m` from the middle of the tips' chords.

    `jitter_s` (rms) and a counter of `clock_hz` (0 is exact) blur each time. `clock_offset_s` shifts all times.
    `missed` is the share of passages that the probe misses.
    """

    kind: Annotated[Literal["blade_tip_timing"], about("Kind of this sensor.")] = "blade_tip_timing"
    angle_deg: Annotated[
        Direction, about("Place on the casing, from +X. Uneven places of several probes tell engine orders apart.")
    ]
    axial_m: Annotated[
        AxialPlace,
        about(
            "Axial place of the probe from the middle of the tips' chords. Another place than 0 sees "
            "torsion of the blades."
        ),
    ] = 0.0
    jitter_s: Annotated[Jitter, about("Rms of the random error of each arrival time.")] = 0.0
    clock_hz: Annotated[RateOrNone, about("Frequency of the counter that rounds the times. 0 is exact.")] = 0.0
    clock_offset_s: Annotated[ClockOffset, about("Shift of all arrival times.")] = 0.0
    missed: Annotated[MissedShare, about("Share of the passages that the probe misses.")] = 0.0

    @property
    def tap(self) -> TipTiming:
        """The passages of the blades under the probe."""
        return TipTiming(name=self.name, angle_deg=self.angle_deg, axial_m=self.axial_m)
