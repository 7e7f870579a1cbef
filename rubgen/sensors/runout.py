"""The profile of the shaft under the proximity probes."""

import numpy as np
from pydantic.dataclasses import dataclass

from rubgen.arrays import FloatArray
from rubgen.machine.quantities import STRICT, Angle, Height, RunoutHarmonic


@dataclass(frozen=True, kw_only=True, config=STRICT)
class RunoutOrder:
    """One order of the shaft's profile under the proximity probes: `amplitude_m` cos(order (angle - phase))."""

    order: RunoutHarmonic
    amplitude_m: Height
    phase_deg: Angle = 0.0


def runout(angle: FloatArray, shaft: tuple[RunoutOrder, ...]) -> FloatArray:
    """Profile of the shaft in m at `angle` (any,) in rad from its mark: sum of amplitude cos(order (angle - phase))."""
    profile = np.zeros_like(angle)
    for part in shaft:
        profile += part.amplitude_m * np.cos(part.order * (angle - np.deg2rad(part.phase_deg)))
    return profile
