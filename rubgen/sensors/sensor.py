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
    about,
)
from rubgen.machine.sentences import CHANNEL_NAME
from rubgen.taps import Tap

Interval = tuple[Reading, Reading]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class RunoutOrder:
    """One order of the shaft's profile under the proximity probes: `amplitude_m` cos(order (angle - phase))."""

    order: Annotated[
        RunoutHarmonic,
        about("How many waves of the profile the shaft has around it. 1 is an eccentric track, 2 an oval one."),
    ]
    amplitude_m: Annotated[Height, about("Amplitude of these waves.")]
    phase_deg: Annotated[Angle, about("Angle of the first high spot from the mark of the shaft.")] = 0.0


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
    """Quantity, axis and location of a channel, as texts."""

    quantity: str
    axis: str
    location: str


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Sensor:
    """A sensor. Its channel or topic has the sensor's name.

    Its random numbers depend on its place in the sensor set.
    """

    name: Annotated[
        str,
        Field(pattern=CHANNEL_NAME),
        about("Name of the sensor. Its channel has it too, so names must differ within a set."),
    ]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class SampledSensor(Sensor, ABC):
    """A sensor with a measuring chain. Every value is in the sensor's `unit`; the defaults are a sensor without errors.

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

    unit: Annotated[
        str, about("Unit of the channel, and of every value of this sensor. Without it the first unit of the kind.")
    ] = ""
    bandwidth_hz: Annotated[
        Rate | None,
        about("Cut-off frequency of the sensor's own second-order low-pass. Without it the sensor has none."),
    ] = None
    resonance_hz: Annotated[
        Rate | None,
        about(
            "Resonance of the sensor on its mounting. Without it the sensor has none; magnets have one at a few kHz."
        ),
    ] = None
    resonance_damping: Annotated[
        ResonanceDamping, about("Damping ratio of that resonance. A lower one is a higher peak.")
    ] = 0.02
    saturation: Annotated[
        Interval | None,
        about(
            "Lower and upper limit at which the amplifier cuts off, before the anti-alias filter, in "
            "the sensor's unit. Without it nothing is cut off there."
        ),
    ] = None
    gain_error: Annotated[GainError, about("Relative error of the calibration: 0.02 reads 2 % too much.")] = 0.0
    offset: Annotated[Reading, about("Constant that is added to each reading, in the sensor's unit.")] = 0.0
    drift_per_s: Annotated[
        Reading, about("Slope that is added from the first sample on, in the sensor's unit a second.")
    ] = 0.0
    noise_rms: Annotated[
        Level, about("Rms of white noise in the recorded band, in the sensor's unit. Take it from the data sheet.")
    ] = 0.0
    noise_density: Annotated[
        Level,
        about(
            "Noise density above the corner, in the sensor's unit over sqrt(Hz). Give it where a data "
            "sheet gives a density instead of an rms."
        ),
    ] = 0.0
    noise_corner_hz: Annotated[
        RateOrNone, about("Frequency below which the power of that noise rises as 1/f. 0 is white noise.")
    ] = 0.0
    range: Annotated[
        Interval | None,
        about("Lower and upper limit of the converter, in the sensor's unit. Without it the range of the kind."),
    ] = None
    adc_bits: Annotated[AdcBits | None, about("Bits of this sensor's converter. Without it those of the recipe.")] = (
        None
    )
    dropouts_per_s: Annotated[
        RateOrNone,
        about(
            "Mean number of gaps a second, in which the last value repeats. Give it for a loose cable or a radio link."
        ),
    ] = 0.0
    dropout_s: Annotated[Duration, about("Length of a gap.")] = 1e-3
    clock_offset_s: Annotated[
        ClockOffset, about("How late the sensor's own clock is. Give it to study channels that are not synchronous.")
    ] = 0.0
    clock_ppm: Annotated[ClockDrift, about("How slow the sensor's own clock is, in parts per million.")] = 0.0

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
        """The largest of `bandwidth_hz` and `resonance_hz`; 0 if both are None."""
        return max(self.bandwidth_hz or 0.0, self.resonance_hz or 0.0)

    @property
    @abstractmethod
    def tap(self) -> Tap:
        """The true signal that the sensor measures."""

    @property
    @abstractmethod
    def description(self) -> Description:
        """Quantity, axis and location of the sensor's channel."""

    @property
    def scale(self) -> tuple[float, float]:
        """Factor and zero from the SI unit to the sensor's unit: value = zero + factor x."""
        return self.UNITS[self.unit], 0.0

    def disturbed(self, signal: FloatArray, _angle: FloatArray, _shaft: tuple[RunoutOrder, ...]) -> FloatArray:
        """Return the sensor's input for the true `signal` (steps,), in the SI unit. By default it is the signal itself.

        `angle` (steps,) is the shaft's angle theta in rad, `shaft` the orders of the shaft's profile.
        """
        return signal

    @property
    def full_range(self) -> tuple[float, float]:
        """Lower and upper end of the range in the sensor's unit: the sensor's `range`, else the range of its kind."""
        factor, zero = self.scale
        low, high = self.RANGE
        return self.range or (zero + factor * low, zero + factor * high)


def axis_of(angle_deg: float) -> str:
    """Return the name of a direction: "X" for 0, "Y" for 90, else the angle, such as "22.5 deg"."""
    return {0.0: "X", 90.0: "Y"}.get(angle_deg, f"{angle_deg:g} deg")
