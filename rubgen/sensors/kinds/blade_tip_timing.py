"""Probe of blade tip timing: the passage of each blade."""

from typing import Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.quantities import STRICT, AxialPlace, ClockOffset, Direction, Jitter, MissedShare, RateOrNone
from rubgen.sensors.sensor import Sensor
from rubgen.taps import TipTiming


@dataclass(frozen=True, kw_only=True, config=STRICT)
class TimingProbe(Sensor):
    """Arrival times of the blades at a place on the casing, `axial_m` from the middle of the tips' chords.

    `jitter_s` (rms) and a counter of `clock_hz` (0 is exact) blur each time. `clock_offset_s` shifts all times.
    `missed` is the share of passages that the probe misses.
    """

    kind: Literal["blade_tip_timing"] = "blade_tip_timing"
    angle_deg: Direction
    axial_m: AxialPlace = 0.0
    jitter_s: Jitter = 0.0
    clock_hz: RateOrNone = 0.0
    clock_offset_s: ClockOffset = 0.0
    missed: MissedShare = 0.0

    @property
    def tap(self) -> TipTiming:
        """The passages of the blades under the probe."""
        return TipTiming(name=self.name, angle_deg=self.angle_deg, axial_m=self.axial_m)
