"""A stepper made ready for a changing speed."""

from __future__ import annotations

import numpy as np

from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import ContactLaw, Operation
from rubgen.scenario.rotation import Rotation
from rubgen.solver.linear.rub_free import rub_free_motion
from rubgen.solver.linear.stability import STEP_SAFETY, settle_turns, slowest_decay, stable_step, steps_per_turn
from rubgen.solver.scheme.model import speed_part
from rubgen.solver.scheme.stepper import Stepper
from rubgen.solver.speed.driver import ChangingSpin
from rubgen.solver.speed.interpolation import Following, SystemAt, chebyshev_speeds
from rubgen.taps import DEFAULT_TAPS, Tap


class ChangingSystem:
    """A system at all speeds of an operation: `systems` at Chebyshev speeds, `start` at the first instant."""

    def __init__(self, system_at: SystemAt, operation: Operation) -> None:
        self.system_at, self.operation, self.rotation = system_at, operation, operation.rotation
        speeds = chebyshev_speeds(self.rotation.slowest, self.rotation.fastest)
        self.systems = [system_at(speed, 0.0) for speed in speeds.tolist()]
        self.speeds, self.start = speeds, system_at(self.rotation.start, 0.0)

    def least_stable(self) -> SpinningSystem:
        """The system of the slowest decay, negative where it grows by itself."""
        return min(self.systems, key=slowest_decay)

    def steps(self, sample_rate_hz: float) -> int:
        """Steps in a turn at the highest speed: `steps_per_turn` there, doubled until all speeds are stable."""
        steps = steps_per_turn(self.systems[-1], self.operation.steps_per_turn, sample_rate_hz)
        longest = STEP_SAFETY * min(stable_step(system) for system in self.systems)
        while 2 * np.pi / self.systems[-1].speed / steps > longest:
            steps *= 2
        return steps

    def spin(self, contact: ContactLaw, steps: int, taps: tuple[Tap, ...] = DEFAULT_TAPS) -> ChangingSpin:
        """A stepper in the rub-free motion of the first instant, and what takes it through the turns."""
        push = largest_acceleration(self.rotation)
        pushed = [self.system_at(speed, push) for speed in (self.rotation.slowest, self.rotation.fastest)]
        stepper = Stepper(self.systems[-1], contact, steps, taps=taps, alike=[*self.systems, *pushed])
        following = Following(
            lambda *at: speed_part(self.system_at(*at), stepper.blocks, stepper.dt), self.speeds, push
        )
        settle = settle_turns(self.start, self.operation)
        spin = ChangingSpin(stepper, following, self.rotation, settle)
        # A turn of the first speed has not a whole number of steps: the balance takes any.
        spin.begin(rub_free_motion(self.start, 2 * np.pi / self.start.speed / stepper.dt))
        return spin


def largest_acceleration(rotation: Rotation) -> float:
    """A bound of |Omega'| in rad/s2."""
    return abs(rotation.rate) + 2 * np.pi / rotation.period * abs(rotation.swing)
