"""Sensors as users describe them: one class a kind. What a kind measures, and how, is in `rubgen.sensors`."""

from __future__ import annotations

from collections import Counter
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator
from pydantic.dataclasses import dataclass

from rubgen.brief import brief
from rubgen.machine.problems import nearest
from rubgen.machine.quantities import (
    STRICT,
    AdcBits,
    Angle,
    AxialPlace,
    Bias,
    BladeNumber,
    ClockDrift,
    ClockOffset,
    Direction,
    Duration,
    GainError,
    Height,
    Jitter,
    Level,
    MissedShare,
    Rate,
    RateOrNone,
    Reading,
    ResonanceDamping,
    RunoutHarmonic,
    Sensitivity,
)
from rubgen.machine.sentences import CHANNEL_NAME

Interval = tuple[Reading, Reading]
GRAVITY = 9.80665
"""Standard gravity in m/s2 (ISO 80000-3)."""


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Sensor:
    """A sensor; its name is that of its channel or topic. Its place in the set decides which random numbers it gets."""

    name: Annotated[str, Field(pattern=CHANNEL_NAME)]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class SampledSensor(Sensor):
    """A sensor with a measuring chain. Every value stands in the sensor's `unit`; the defaults are without fault.

    In the order of the chain (docs/sensors.md): `bandwidth_hz` of a second-order Butterworth low-pass, `resonance_hz`
    with `resonance_damping`, `saturation` before the anti-alias filter; `gain_error` as a share, `offset`,
    `drift_per_s` from the first sample on; `noise_rms` white in the recorded band, `noise_density` per sqrt(Hz), whose
    power rises as 1/f below `noise_corner_hz`; `range` and `adc_bits` of the converter (None takes the kind's and the
    recipe's); `dropouts_per_s` gaps of `dropout_s` each, in which the last value is held. The sensor's own clock runs
    late by `clock_offset_s` and slow by `clock_ppm`.
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
            raise ValueError(f"unit = {self.unit!r} of {self.name}: unknown unit; {nearest(self.unit, [*self.UNITS])}")
        for key in ("range", "saturation"):
            limits = getattr(self, key)
            if limits is not None and limits[0] >= limits[1]:
                raise ValueError(f"{key} = {list(limits)} of {self.name}: must ascend; give the lower limit first")
        return self

    @property
    def scale(self) -> tuple[float, float]:
        """Factor and zero from the SI unit to the sensor's."""
        return self.UNITS[self.unit], 0.0

    @property
    def full_range(self) -> tuple[float, float]:
        """The range in the sensor's unit: its own, or the kind's."""
        factor, zero = self.scale
        low, high = self.RANGE
        return self.range or (zero + factor * low, zero + factor * high)

    @property
    def front_end_hz(self) -> float:
        """The highest frequency that the sensor's own dynamics name, 0 without any."""
        return max(self.bandwidth_hz or 0.0, self.resonance_hz or 0.0)


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Proximity(SampledSensor):
    """Displacement of the disk centre along a direction; in V the gap voltage, `bias_v` at rest, rising with it."""

    UNITS: ClassVar[dict[str, float]] = {"m": 1.0, "mm": 1e3, "um": 1e6, "V": 0.0}
    RANGE: ClassVar[tuple[float, float]] = (-2e-3, 2e-3)
    kind: Literal["proximity"] = "proximity"
    angle_deg: Direction
    sensitivity_v_per_m: Sensitivity = 7874.0
    bias_v: Bias = -10.0

    @property
    def scale(self) -> tuple[float, float]:
        """Gap voltage = bias + sensitivity x: the gap closes as the shaft comes nearer, the negative voltage rises."""
        return (self.sensitivity_v_per_m, self.bias_v) if self.unit == "V" else super().scale


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Accelerometer(SampledSensor):
    """Radial acceleration of the casing, positive outward."""

    UNITS: ClassVar[dict[str, float]] = {"m/s2": 1.0, "g": 1 / GRAVITY}
    RANGE: ClassVar[tuple[float, float]] = (-5e4, 5e4)
    kind: Literal["accelerometer"] = "accelerometer"
    angle_deg: Direction


@dataclass(frozen=True, kw_only=True, config=STRICT)
class BladeStrain(SampledSensor):
    """Spanwise strain at a blade's root."""

    UNITS: ClassVar[dict[str, float]] = {"1": 1.0, "um/m": 1e6}
    RANGE: ClassVar[tuple[float, float]] = (-5e-3, 5e-3)
    kind: Literal["blade_strain"] = "blade_strain"
    blade: BladeNumber


@dataclass(frozen=True, kw_only=True, config=STRICT)
class CasingStrain(SampledSensor):
    """Hoop strain at the outer face of the casing."""

    UNITS: ClassVar[dict[str, float]] = {"1": 1.0, "um/m": 1e6}
    RANGE: ClassVar[tuple[float, float]] = (-5e-3, 5e-3)
    kind: Literal["casing_strain"] = "casing_strain"
    angle_deg: Direction


@dataclass(frozen=True, kw_only=True, config=STRICT)
class SupportForceSensor(SampledSensor):
    """Dynamic force of the disk on its support along a direction."""

    UNITS: ClassVar[dict[str, float]] = {"N": 1.0, "kN": 1e-3}
    RANGE: ClassVar[tuple[float, float]] = (-2.5e5, 2.5e5)
    kind: Literal["support_force"] = "support_force"
    angle_deg: Direction


@dataclass(frozen=True, kw_only=True, config=STRICT)
class ContactForceSensor(SampledSensor):
    """The sum of the normal contact forces: no probe measures it."""

    UNITS: ClassVar[dict[str, float]] = {"N": 1.0, "kN": 1e-3}
    RANGE: ClassVar[tuple[float, float]] = (-1e5, 1e5)
    kind: Literal["contact_force"] = "contact_force"


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Torque(SampledSensor):
    """Torque on the blisk about the axis: of the drive, or (what no sensor measures) of the contact."""

    UNITS: ClassVar[dict[str, float]] = {"N m": 1.0, "kN m": 1e-3}
    RANGE: ClassVar[tuple[float, float]] = (-2e4, 2e4)
    kind: Literal["torque"] = "torque"
    of: Literal["drive", "contact"] = "drive"


@dataclass(frozen=True, kw_only=True, config=STRICT)
class ClearanceProbe(SampledSensor):
    """Gap between the blade tips and the casing."""

    UNITS: ClassVar[dict[str, float]] = {"m": 1.0, "mm": 1e3, "um": 1e6}
    RANGE: ClassVar[tuple[float, float]] = (-1e-3, 1.2e-2)
    kind: Literal["tip_clearance"] = "tip_clearance"
    angle_deg: Direction


@dataclass(frozen=True, kw_only=True, config=STRICT)
class TimingProbe(Sensor):
    """Arrival times of the blades at a place on the casing, `axial_m` from the middle of the tips' chords.

    `jitter_s` rms and a counter of `clock_hz` (0 is exact) blur each time, `clock_offset_s` shifts all, `missed` is the
    share of passages that the probe does not see.
    """

    kind: Literal["blade_tip_timing"] = "blade_tip_timing"
    angle_deg: Direction
    axial_m: AxialPlace = 0.0
    jitter_s: Jitter = 0.0
    clock_hz: RateOrNone = 0.0
    clock_offset_s: ClockOffset = 0.0
    missed: MissedShare = 0.0


@dataclass(frozen=True, kw_only=True, config=STRICT)
class OncePerRev(Sensor):
    """The pulse of a notch on the shaft that passes at theta = 0, and its arrival times, blurred as those of blades."""

    kind: Literal["once_per_rev"] = "once_per_rev"
    jitter_s: Jitter = 0.0
    clock_hz: RateOrNone = 0.0


AnySensor = Annotated[
    Proximity
    | Accelerometer
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
KINDS = (
    "proximity", "accelerometer", "blade_strain", "casing_strain", "support_force", "contact_force", "torque",
    "tip_clearance", "blade_tip_timing", "once_per_rev",
)  # fmt: skip


@dataclass(frozen=True, kw_only=True, config=STRICT)
class RunoutOrder:
    """One order of the shaft's profile under the proximity probes: `amplitude_m` cos(order (angle - phase))."""

    order: RunoutHarmonic
    amplitude_m: Height
    phase_deg: Angle = 0.0


@dataclass(frozen=True, kw_only=True, config=STRICT)
class SensorSet:
    """All sensors of a machine, and the profile of its shaft."""

    name: Annotated[str, Field(min_length=1)]
    sensors: Annotated[tuple[AnySensor, ...], Field(min_length=1)]
    shaft_runout: tuple[RunoutOrder, ...] = ()

    __repr__ = brief

    @model_validator(mode="after")
    def _names_differ(self) -> Self:
        name, count = Counter(sensor.name for sensor in self.sensors).most_common(1)[0]
        if count > 1:
            raise ValueError(f"name = {name!r} of {count} sensors: must differ; rename all but one")
        if sum(isinstance(sensor, OncePerRev) for sensor in self.sensors) > 1:
            raise ValueError("two sensors of kind once_per_rev: there is one pulse a turn; keep one of them")
        if not self.sampled:
            raise ValueError("sensors: none records a signal (kinds once_per_rev and blade_tip_timing only); add one")
        return self

    @property
    def sampled(self) -> tuple[SampledSensor, ...]:
        """Those with a measuring chain."""
        return tuple(sensor for sensor in self.sensors if isinstance(sensor, SampledSensor))

    @property
    def front_end_hz(self) -> float:
        """The highest frequency that any sensor's own dynamics name, 0 without any."""
        return max((sensor.front_end_hz for sensor in self.sampled), default=0.0)
