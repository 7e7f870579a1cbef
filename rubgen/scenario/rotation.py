"""The rotation of the blisk: speed and angle as exact functions of time."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray

NEWTON_STEPS = 50
ANGLE_TOLERANCE = 1e-13
"""Newton's method for a time ends where the error of the angle is below this share of the angle and of one radian."""


@dataclass(frozen=True, kw_only=True)
class Rotation:
    """Omega(t) and theta(t), theta = 0 at t = 0. Speeds are in rad/s, times in s; both have any sign.

    Omega is `start` up to t = 0, then linear to `end` at t = `seconds`, then constant. The fluctuation swing sin(2 pi t
    / period) is added at all times. Omega must stay positive.
    """

    start: float
    end: float
    seconds: float = 1.0
    swing: float = 0.0
    period: float = 1.0

    @property
    def is_steady(self) -> bool:
        """Whether the speed never changes."""
        return self.start == self.end and self.swing == 0

    @property
    def slowest(self) -> float:
        """The lowest speed, in rad/s."""
        return min(self.start, self.end) - abs(self.swing)

    @property
    def fastest(self) -> float:
        """The highest speed, in rad/s."""
        return max(self.start, self.end) + abs(self.swing)

    @property
    def rate(self) -> float:
        """Angular acceleration of the ramp, in rad/s2."""
        return (self.end - self.start) / self.seconds

    def speed(self, time: npt.ArrayLike) -> FloatArray:
        """Return Omega in rad/s at `time` (any shape) in s."""
        ramp = self.start + self.rate * np.clip(time, 0.0, self.seconds)
        return np.asarray(ramp + self.swing * np.sin(self._phase(time)))

    def acceleration(self, time: npt.ArrayLike) -> FloatArray:
        """Return Omega' in rad/s2 at `time` (any shape) in s.

        The ramp's acceleration counts from t = 0 to t = `seconds`, both included.
        """
        time = np.asarray(time)
        ramp = np.where((time >= 0) & (time <= self.seconds), self.rate, 0.0)
        return np.asarray(ramp + self.swing * (2 * np.pi / self.period) * np.cos(self._phase(time)))

    def angle(self, time: npt.ArrayLike) -> FloatArray:
        """Return theta in rad at `time` (any shape) in s: the integral of Omega from 0."""
        time = np.asarray(time, dtype=np.float64)
        within = np.clip(time, 0.0, self.seconds)
        after = np.maximum(time - self.seconds, 0.0)
        ramp = self.start * (time - after) + 0.5 * self.rate * within**2 + self.end * after
        # 1 - cos as 2 sin^2: exact near t = 0.
        wave = self.swing * (self.period / np.pi) * np.sin(0.5 * self._phase(time)) ** 2
        return np.asarray(ramp + wave)

    def time_of(self, angle: float) -> float:
        """Return the time in s at which theta is `angle` (rad): exactly, or with a fluctuation by Newton's method."""
        time = self._ramp_time(angle)
        if self.swing == 0:
            return time
        for _ in range(NEWTON_STEPS):
            error = float(self.angle(time)) - angle
            if abs(error) <= ANGLE_TOLERANCE * max(1.0, abs(angle)):
                break
            time -= error / float(self.speed(time))
        return time

    def mean_speed(self, angle: float) -> float:
        """Return the mean speed in rad/s from theta = 0 to `angle` (rad, positive)."""
        return self.start if self.is_steady else angle / self.time_of(angle)

    def _ramp_time(self, angle: float) -> float:
        """Return the time of an angle without fluctuation."""
        ramped = 0.5 * (self.start + self.end) * self.seconds
        if angle <= 0:
            return angle / self.start
        if angle >= ramped:
            return self.seconds + (angle - ramped) / self.end
        # The root of start t + rate t^2 / 2 = angle in the form that does not cancel.
        return 2 * angle / (self.start + math.sqrt(self.start**2 + 2 * self.rate * angle))

    def _phase(self, time: npt.ArrayLike) -> FloatArray:
        return np.asarray(2 * np.pi * np.asarray(time) / self.period)


def steady_rotation(speed: float) -> Rotation:
    """Return the rotation at a constant speed in rad/s."""
    return Rotation(start=speed, end=speed)
