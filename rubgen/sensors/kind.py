"""What a kind of sampled sensor is: which true signal it takes, and how its channel is described."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray
from rubgen.scenario.sensors import SensorSet
from rubgen.scenario.taps import Tap


@dataclass(frozen=True, kw_only=True)
class Description:
    """What a channel measures, along which axis, and where."""

    quantity: str
    axis: str
    location: str


def undisturbed(_sensor: Any, signal: FloatArray, _angle: FloatArray, _sensors: SensorSet) -> FloatArray:
    """The signal itself."""
    return signal


@dataclass(frozen=True, kw_only=True)
class Kind:
    """A kind of sampled sensor; each function takes the sensor first.

    `tap` gives the true signal it sees, `disturb` what else it sees: the signal in
    its SI unit (steps,), the shaft's angle theta at each (steps,), the set.
    """

    describe: Callable[[Any], Description]
    tap: Callable[[Any], Tap]
    disturb: Callable[[Any, FloatArray, FloatArray, SensorSet], FloatArray] = undisturbed


def label(value: float) -> str:
    """A number as part of a tap's name: 22.5 is 22p5."""
    return f"{value:.10g}".replace(".", "p").replace("-", "m").replace("+", "")


def along(angle_deg: float) -> str:
    """A direction as an axis: X, Y or the angle."""
    return {0.0: "X", 90.0: "Y"}.get(angle_deg, f"{angle_deg:g} deg")


def in_turn(angle: npt.NDArray[np.floating[Any]]) -> FloatArray:
    """An angle in [0, 2 pi)."""
    turned = np.mod(angle, 2 * np.pi)
    return np.asarray(np.where(turned < 2 * np.pi, turned, 0.0))
