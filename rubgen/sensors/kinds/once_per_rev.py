"""The once-per-revolution pulse of a notch on the shaft."""

from typing import Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.quantities import STRICT, Jitter, RateOrNone
from rubgen.sensors.sensor import Sensor


@dataclass(frozen=True, kw_only=True, config=STRICT)
class OncePerRev(Sensor):
    """The pulse of a notch on the shaft that passes at theta = 0, and its arrival times with jitter."""

    kind: Literal["once_per_rev"] = "once_per_rev"
    jitter_s: Jitter = 0.0
    clock_hz: RateOrNone = 0.0
