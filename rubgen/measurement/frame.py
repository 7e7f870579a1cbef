"""Compute the motion of the frame: what forces of the disk's support do to bearing housing and casing, one way."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.machine.frame import Frame, FrameMode
from rubgen.machine.quantities import FRAME_HZ, MODAL_KG


@dataclass(frozen=True, kw_only=True)
class FrameMotion:
    """Accelerations of a machine's frame under the forces of the disk on its support.

    The forces are linear between the steps. A mode with two steps a period or fewer is left out: the steps cannot
    resolve it.
    """

    frame: Frame
    force: tuple[FloatArray, FloatArray]
    """Forces of the disk on its support along X and Y (steps,), N."""
    dt: float
    """Time step, s."""

    def of_housing(self, angle_deg: float) -> FloatArray:
        """Return the acceleration (steps,) of the bearing housing in m/s2 along `angle_deg`, measured from +X."""
        return self._sum([_cosine(angle_deg - mode.direction_deg) for mode in self.frame.modes])

    def of_casing(self, angle_deg: float) -> FloatArray:
        """Return the radial acceleration (steps,) of the casing in m/s2, outward, at the polar angle `angle_deg`."""
        turned = [mode.casing_order * (angle_deg - mode.casing_angle_deg) for mode in self.frame.modes]
        return self._sum([mode.casing_share * _cosine(a) for mode, a in zip(self.frame.modes, turned, strict=True)])

    def _sum(self, factors: list[float]) -> FloatArray:
        return np.asarray(np.array(factors)[self._shown] @ self._accelerations)

    @cached_property
    def _shown(self) -> list[int]:
        """Numbers of the modes that the steps show."""
        return [number for number, mode in enumerate(self.frame.modes) if 2 * mode.frequency_hz * self.dt < 1]

    @cached_property
    def _accelerations(self) -> FloatArray:
        """Acceleration q'' of each mode that is shown (modes, steps), in m/s2."""
        found, (x, y) = np.zeros((len(self._shown), self.force[0].size)), self.force
        for row, number in zip(found, self._shown, strict=True):
            mode = self.frame.modes[number]
            along = _cosine(mode.direction_deg) * x + _cosine(mode.direction_deg - 90) * y
            row[:] = accelerations(mode, along, self.dt)
        return found


def accelerations(mode: FrameMode, force: FloatArray, dt: float) -> FloatArray:
    """Compute the acceleration q'' (steps,) of a mode in m/s2: q'' + 2 d w q' + w^2 q = F / m.

    F is linear between the steps, and the result is exact at the steps, by the recursion of Smallwood (1981, ramp
    invariant; ISO 18431-4): with E = exp(-d w dt) and K = w dt sqrt(1 - d^2), H(z) = E sin(K) / K (1 - 1/z)^2 / (1 - 2
    E cos(K) / z + E^2 / z^2). The mode starts at rest, in equilibrium with the first force, so the first value is 0.

    - mode: its frequency w, damping ratio d and modal mass m.
    - force (steps,): F, N.
    - dt: time step, s.
    """
    from scipy.signal import lfilter  # slow to import

    w = 2 * np.pi * mode.frequency_hz
    decay, turned = np.exp(-mode.damping * w * dt), w * dt * np.sqrt(1 - mode.damping**2)
    gain = decay * np.sin(turned) / turned / mode.modal_mass_kg
    filtered = lfilter(gain * np.array([1, -2, 1]), [1, -2 * decay * np.cos(turned), decay**2], force - force[0])
    return np.asarray(filtered, dtype=np.float64)


def _cosine(angle_deg: float) -> float:
    return float(np.cos(np.deg2rad(angle_deg)))


def spread(frame: Frame, deviation: float, rng: np.random.Generator) -> Frame:
    """Draw the frame of another machine of the same kind. With `deviation` 0 the frame is returned unchanged.

    Each frequency and each mass is multiplied by exp(`deviation` x), x standard normal: `deviation` is the standard
    deviation of the logarithm. Values outside of the allowed range are set to its nearest end. Damping, directions and
    casing shares are not changed.
    """
    if deviation == 0:
        return frame
    factors = np.exp(deviation * rng.standard_normal((len(frame.modes), 2)))
    modes = (
        replace(
            mode,
            frequency_hz=float(np.clip(mode.frequency_hz * frequency, *FRAME_HZ)),
            modal_mass_kg=float(np.clip(mode.modal_mass_kg * mass, *MODAL_KG)),
        )
        for mode, (frequency, mass) in zip(frame.modes, factors, strict=True)
    )
    return Frame(modes=tuple(modes))
