"""Prepare a stepper for a changing speed."""

import numpy as np

from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import ContactLaw, Operation
from rubgen.scenario.rotation import Rotation
from rubgen.solver.linear.rub_free import rub_free_motion
from rubgen.solver.linear.stability import STEP_SAFETY, settle_turns, slowest_decay, stable_step, steps_per_turn
from rubgen.solver.scheme.model import speed_part
from rubgen.solver.scheme.speed_part import SpeedPart
from rubgen.solver.scheme.stepper import Stepper
from rubgen.solver.speed.driver import ChangingDriver
from rubgen.solver.speed.interpolation import SpeedInterpolation, chebyshev_speeds
from rubgen.solver.wants import SpeedModel
from rubgen.taps import DEFAULT_TAPS, Tap


class ChangingSystem:
    """A system at the speeds of an operation: `systems` at Chebyshev speeds, `start` at `rotation.start`.

    That is the speed before the record of a run-up or coast-down, and the mean of a fluctuating speed.
    """

    def __init__(self, model: SpeedModel, operation: Operation) -> None:
        self.model, self.operation, self.rotation = model, operation, operation.rotation
        speeds = chebyshev_speeds(self.rotation.slowest, self.rotation.fastest)
        self.systems = [model.at_speed(speed, 0.0) for speed in speeds.tolist()]
        self.speeds, self.start = speeds, model.at_speed(self.rotation.start, 0.0)

    def least_stable(self) -> SpinningSystem:
        """Return the system with the slowest decay; the decay is negative where it grows by itself."""
        return min(self.systems, key=slowest_decay)

    def steps(self, sample_rate_hz: float) -> int:
        """Return the steps in a turn at the highest speed: the operation's number, doubled until all speeds are stable.

        They are also enough for `sample_rate_hz`, the sensors' rate. Raises UserError for a system that would need more
        than 4,194,304 steps at the highest speed.
        """
        steps = steps_per_turn(self.systems[-1], self.operation.steps_per_turn, sample_rate_hz)
        longest = STEP_SAFETY * min(stable_step(system) for system in self.systems)
        while 2 * np.pi / self.systems[-1].speed / steps > longest:
            steps *= 2
        return steps

    def driver(self, contact: ContactLaw, steps: int, taps: tuple[Tap, ...] = DEFAULT_TAPS) -> ChangingDriver:
        """Return a driver at the beginning of the settle turns, in the rub-free motion of `start`.

        `steps` is the number in a turn at the highest speed, from the method `steps`. Raises ValueError for automatic
        settle turns of an unstable system.
        """
        push = largest_acceleration(self.rotation)
        pushed = [self.model.at_speed(speed, push) for speed in (self.rotation.slowest, self.rotation.fastest)]
        stepper = Stepper(self.systems[-1], contact, steps, taps=taps, alike=[*self.systems, *pushed])

        def part_at(speed: float, acceleration: float) -> SpeedPart:
            return speed_part(self.model.at_speed(speed, acceleration), stepper.blocks, stepper.dt)

        matrices = SpeedInterpolation(part_at, self.speeds, push)
        driver = ChangingDriver(stepper, matrices, self.rotation, settle_turns(self.start, self.operation))
        # A turn of the first speed has not a whole number of steps: the balance takes any.
        driver.begin(rub_free_motion(self.start, 2 * np.pi / self.start.speed / stepper.dt))
        return driver


def largest_acceleration(rotation: Rotation) -> float:
    """Return a bound of |Omega'| in rad/s2."""
    return abs(rotation.rate) + 2 * np.pi / rotation.period * abs(rotation.swing)
