"""The steps of a run that are measured, and signals that follow the angle of the shaft over them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from rubgen.arrays import ComplexArray, FloatArray

BLOCK = 1024
"""Steps of a sinusoid that are computed from one of its exponentials."""


@dataclass(frozen=True, kw_only=True)
class Tail:
    """The steps that are measured: step length `dt` in s, theta `angle` (steps,) in rad and `speed` (steps,) in rad/s.

    The step after the last one has theta = 0.
    """

    dt: float
    angle: FloatArray
    speed: FloatArray
    seconds: float
    """Length of the recording in s."""
    blades: int
    turn: int | None = None
    """Number of steps of each turn where the speed is steady; None where it is not known to be."""

    @property
    def time(self) -> FloatArray:
        """Time (steps,) in s, negative, counted from the step after the last one.

        It does not depend on the tail's length.
        """
        return np.asarray(self.dt * np.arange(-self.angle.size, 0), dtype=np.float64)

    @cached_property
    def once(self) -> Tail:
        """The last turn if all turns are known to be equal, else the whole tail.

        Signals that follow the angle are computed only there.
        """
        if self.turn is None or self.turn >= self.angle.size:
            return self
        return replace(self, angle=self.angle[-self.turn :], speed=self.speed[-self.turn :])

    def everywhere(self, signal: FloatArray) -> FloatArray:
        """Return `signal`, which has a value for each step of `once`, at all steps of the tail.

        It is repeated turn by turn, backward from the last step.
        """
        if signal.size == self.angle.size:
            return signal
        turns = -(-self.angle.size // signal.size)
        return np.tile(signal, turns)[turns * signal.size - self.angle.size :]

    @cached_property
    def turned(self) -> FloatArray:
        """Angle (steps,) in rad without jumps, counted from the step after the last one, where it is 0 mod 2 pi."""
        if self.turn is not None:
            return np.asarray(2 * np.pi / self.turn * np.arange(-self.angle.size, 0))
        angle = np.unwrap(self.angle)
        return np.asarray(angle - angle[-1] + self.angle[-1] - 2 * np.pi)

    def wave(self, order: float) -> ComplexArray:
        """Return exp(i order theta) (steps,), with theta without jumps. `order` is 0 or more, and may be fractional.

        The array may be kept for further calls: do not change it.
        """
        if not float(order).is_integer():
            return np.asarray(np.exp(1j * order * self.turned))
        if order not in self._waves:
            half = order // 2
            self._waves[order] = self.wave(half) * self.wave(order - half)
        return self._waves[order]

    @cached_property
    def _waves(self) -> dict[float, ComplexArray]:
        return {0: np.ones(self.angle.size, dtype=np.complex128), 1: np.asarray(np.exp(1j * self.angle))}

    def resolved(self, order: float) -> npt.NDArray[np.bool_]:
        """Return whether an order of the rotation has more than two steps a period, at each step (steps,)."""
        return np.asarray(order * self.speed * self.dt < np.pi)

    def sinusoids(self, amplitudes: ComplexArray, advances: FloatArray) -> FloatArray:
        """Return sum_j Re(a_j exp(i w_j n)) (steps,), with n counted from the step after the last one: -steps to -1.

        The exponential of n = BLOCK k + m is the product of the exponentials of BLOCK k and of m, so few are computed.

        - amplitudes (sinusoids,): complex amplitudes a.
        - advances (sinusoids,): w, rad a step.
        """
        blocks = -(-self.angle.size // BLOCK)
        far = amplitudes * np.exp(1j * np.multiply.outer(BLOCK * np.arange(-blocks, 0), advances))
        near = np.exp(1j * np.multiply.outer(advances, np.arange(BLOCK)))
        whole = np.concatenate([far.real, -far.imag], axis=1) @ np.concatenate([near.real, near.imag])
        return np.asarray(whole.ravel()[blocks * BLOCK - self.angle.size :])
