"""All sensors of a machine."""

from collections import Counter
from typing import Annotated, Self

from pydantic import Field, model_validator
from pydantic.dataclasses import dataclass

from rubgen.brief import brief
from rubgen.machine.quantities import STRICT, about
from rubgen.sensors.kinds.blade_tip_timing import TimingProbe
from rubgen.sensors.kinds.once_per_rev import OncePerRev
from rubgen.sensors.registry import AnySensor
from rubgen.sensors.sensor import RunoutOrder, SampledSensor
from rubgen.taps import DEFAULT_TAPS, HousingAcceleration, Tap


@dataclass(frozen=True, kw_only=True, config=STRICT)
class SensorSet:
    """All sensors of a machine, and the profile of its shaft."""

    name: Annotated[str, Field(min_length=1), about("Name of the set, in messages and in the manifest.")]
    sensors: Annotated[
        tuple[AnySensor, ...],
        Field(min_length=1),
        about("The sensors. The order decides their random numbers, so append new ones at the end."),
    ]
    shaft_runout: Annotated[
        tuple[RunoutOrder, ...],
        about("The profile of the shaft under the proximity probes, by orders. Without it the shaft is round."),
    ] = ()

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
        """The sensors with a measuring chain."""
        return tuple(sensor for sensor in self.sensors if isinstance(sensor, SampledSensor))

    @property
    def on_housing(self) -> tuple[SampledSensor, ...]:
        """The sensors that feel only the machine's frame: accelerometers on the bearing housing."""
        return tuple(sensor for sensor in self.sampled if isinstance(sensor.tap, HousingAcceleration))

    @property
    def front_end_hz(self) -> float:
        """The highest bandwidth or resonance of the set's sensors, Hz; 0 if no sensor has one."""
        return max((sensor.front_end_hz for sensor in self.sampled), default=0.0)

    @property
    def taps(self) -> tuple[Tap, ...]:
        """The true signals that the solver must record, each once: the default taps, then further taps of sensors."""
        housing = self.on_housing
        solved = (sensor.tap for sensor in self.sampled if sensor not in housing)
        sampled = dict.fromkeys([*DEFAULT_TAPS, *solved])
        return (*sampled, *(sensor.tap for sensor in self.sensors if isinstance(sensor, TimingProbe)))
