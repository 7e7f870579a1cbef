"""Sensors: their values, their true signal, and the description of their channel."""

from abc import ABC, abstractmethod
from dataclasses import dataclass as plain_dataclass
from typing import Annotated, ClassVar, Self

import numpy as np
from pydantic import Field, model_validator
from pydantic.dataclasses import dataclass

from rubgen.arrays import FloatArray
from rubgen.machine.problems import nearest
from rubgen.machine.quantities import (
    STRICT,
    AdcBits,
    Angle,
    ClockDrift,
    ClockOffset,
    Duration,
    GainError,
    Height,
    Level,
    Rate,
    RateOrNone,
    Reading,
    ResonanceDamping,
    RunoutHarmonic,
)
from rubgen.machine.sentences import CHANNEL_NAME
from rubgen.taps import Tap

Interval = tuple[Reading, Reading]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class RunoutOrder:
    """One order of the shaft's profile under the proximity probes: `amplitude_m` cos(order (angle - phase))."""

    order: RunoutHarmonic
    amplitude_m: Height
    phase_deg: Angle = 0.0


def runout(angle: FloatArray, shaft: tuple[RunoutOrder, ...]) -> FloatArray:
    """Return the profile of the shaft in m at `angle` (any,) in rad from its mark.

    It is the sum of amplitude cos(order (angle - phase)) over the orders in `shaft`.
    """
    profile = np.zeros_like(angle)
    for part in shaft:
        profile += part.amplitude_m * np.cos(part.order * (angle - np.deg2rad(part.phase_deg)))
    return profile


@plain_dataclass(frozen=True, kw_only=True)
class Description:
    """Quantity, axis and location of a channel."""

    quantity: str
    axis: str
    location: str


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Sensor:
    """A sensor. Its channel or topic has its name. Its random numbers depend on its place in the set."""

    name: Annotated[str, Field(pattern=CHANNEL_NAME)]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class SampledSensor(Sensor, ABC):
    """A sensor with a measuring chain. Every value is in the sensor's `unit`; the defaults are without fault.

    In the order of the chain (docs/sensors.md): `bandwidth_hz` of a second-order Butterworth low-pass, `resonance_hz`
    with `resonance_damping`, `saturation` before the anti-alias filter; `gain_error` as a share, `offset`,
    `drift_per_s` from the first sample on; `noise_rms` white in the recorded band, `noise_density` per sqrt(Hz), whose
    power rises as 1/f below `noise_corner_hz`; `range` and `adc_bits` of the converter (None is the value of the kind
    and the recipe); `dropouts_per_s` gaps of `dropout_s` each, in which the last value repeats. The sensor's own clock
    is late by `clock_offset_s` and slow by `clock_ppm`.
    """

    UNITS: ClassVar[dict[str, float]] = {}
    """Each unit with the factor from the SI unit."""
    RANGE: ClassVar[tuple[float, float]] = (0.0, 0.0)
    """The kind's range, in the SI unit."""

    unit: str = ""
    bandwidth_hz: Rate | None = None
    resonance_hz: Rate | None = None
    resonance_damping: ResonanceDamping = 0.02
    saturation: Interval | None = None
    gain_error: GainError = 0.0
    offset: Reading = 0.0
    drift_per_s: Reading = 0.0
    noise_rms: Level = 0.0
    noise_density: Level = 0.0
    noise_corner_hz: RateOrNone = 0.0
    range: Interval | None = None
    adc_bits: AdcBits | None = None
    dropouts_per_s: RateOrNone = 0.0
    dropout_s: Duration = 1e-3
    clock_offset_s: ClockOffset = 0.0
    clock_ppm: ClockDrift = 0.0

    @model_validator(mode="after")
    def _has_a_unit(self) -> Self:
        if not self.unit:
            object.__setattr__(self, "unit", next(iter(self.UNITS)))
        if self.unit not in self.UNITS:
            unknown = f"unit = {self.unit!r:.60} of {self.name}: unknown unit"
            raise ValueError(f"{unknown}; {nearest(self.unit, [*self.UNITS])}")
        for key in ("range", "saturation"):
            limits = getattr(self, key)
            if limits is not None and limits[0] >= limits[1]:
                raise ValueError(f"{key} = {list(limits)} of {self.name}: must ascend; give the lower limit first")
        return self

    @property
    def front_end_hz(self) -> float:
        """The highest frequency of the sensor's own dynamics; 0 without any."""
        return max(self.bandwidth_hz or 0.0, self.resonance_hz or 0.0)

    @property
    @abstractmethod
    def tap(self) -> Tap:
        """The true signal that the sensor measures."""

    @property
    @abstractmethod
    def description(self) -> Description:
        """Quantity, axis and location of its channel."""

    @property
    def scale(self) -> tuple[float, float]:
        """Factor and zero from the SI unit to the sensor's: value = zero + factor x."""
        return self.UNITS[self.unit], 0.0

    def disturbed(self, signal: FloatArray, _angle: FloatArray, _shaft: tuple[RunoutOrder, ...]) -> FloatArray:
        """Return the input of the sensor for the true `signal` (steps,), in the SI unit: the signal itself, by default.

        `angle` (steps,) is the shaft's angle theta in rad, `shaft` its profile.
        """
        return signal

    @property
    def full_range(self) -> tuple[float, float]:
        """The range in the sensor's unit: its own, or the range of its kind."""
        factor, zero = self.scale
        low, high = self.RANGE
        return self.range or (zero + factor * low, zero + factor * high)


def axis_of(angle_deg: float) -> str:
    """Name a direction as an axis: "X", "Y" or the angle in degrees."""
    return {0.0: "X", 90.0: "Y"}.get(angle_deg, f"{angle_deg:g} deg")
