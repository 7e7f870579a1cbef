"""The once-per-revolution pulse of a notch on the shaft."""

from typing import Annotated, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.quantities import STRICT, Jitter, RateOrNone, about
from rubgen.sensors.sensor import Sensor


@dataclass(frozen=True, kw_only=True, config=STRICT)
class OncePerRev(Sensor):
    """The pulse of a notch on the shaft that passes at theta = 0, and its arrival times with jitter."""

    kind: Annotated[Literal["once_per_rev"], about("Kind of this sensor.")] = "once_per_rev"
    jitter_s: Annotated[Jitter, about("Rms of the random error of each arrival time.")] = 0.0
    clock_hz: Annotated[RateOrNone, about("Frequency of the counter that rounds the times. 0 is exact.")] = 0.0
