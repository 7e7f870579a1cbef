"""Start a run: in the rub-free motion, with the casing's surface opened so that nothing touches."""

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import ContactLaw
from rubgen.solver.linear.rub_free import RubFreeMotion, rub_free_motion
from rubgen.solver.scheme.stepper import Stepper
from rubgen.taps import DEFAULT_TAPS, Tap

START_CLEARANCE_SHARE = 2.5e-4
"""Least clearance between tips and casing at the start, as a share of the tip radius."""


def rub_free_stepper(
    system: SpinningSystem,
    contact: ContactLaw,
    steps: int,
    *,
    start_angle: float = 0.0,
    screen: bool = True,
    taps: tuple[Tap, ...] = DEFAULT_TAPS,
) -> Stepper:
    """Make a stepper in the rub-free motion of the time-stepping scheme, at the beginning of a turn.

    `steps` is the number in a turn, `start_angle` theta at its beginning, rad. `taps` are the true signals to record.
    `screen` False evaluates every blade's gap in every step, with the same result. The surface is not opened here.
    Raises UserError for a step above the stability limit.
    """
    stepper = Stepper(system, contact, steps, start_angle=start_angle, screen=screen, taps=taps)
    set_motion(stepper, rub_free_motion(system, steps), start_angle)
    return stepper


def set_motion(stepper: Stepper, motion: RubFreeMotion, start_angle: float = 0.0) -> None:
    """Put a stepper of equal steps into a rub-free motion. `start_angle` is theta at its turn's first step, rad."""
    stepper.set_coordinates(*(motion.at(start_angle + 2 * np.pi * s / stepper.steps) for s in (-1, 0)))


def start_opening(system: SpinningSystem, inset: float = 0.0) -> float:
    """Return the opening of the surface, m, with which every tip of the rub-free motion has the start clearance.

    The start clearance is 2.5e-4 of the tip radius, from the narrowest radius of the surface. The opening is added to
    the radius of the surface; it is 0 where the clearance is large enough. `inset` (m) is how far the surface may lie
    inside the smooth curve.
    """
    motion = rub_free_motion(system)
    tips = motion.over_turn()[:, : 3 * system.n_blades].reshape(-1, system.n_blades, 3) + system.tip_static
    farthest = float(np.hypot(system.tip_radius + tips[..., 0], tips[..., 1]).max())
    narrowest = system.surface.mean_radius - float(np.abs(system.surface.amplitude).sum()) - inset
    return max(0.0, START_CLEARANCE_SHARE * system.tip_radius - (narrowest - farthest))


def closing_ramp(share: FloatArray) -> FloatArray:
    """Return 1 - (10 x^3 - 15 x^4 + 6 x^5) for x = `share` clipped to [0, 1].

    It falls from one to zero with a continuous second derivative.
    """
    x = np.clip(share, 0.0, 1.0)
    return np.asarray(1 - x**3 * (10 - 15 * x + 6 * x**2))


def narrowed(system: SpinningSystem, time: FloatArray) -> FloatArray:
    """Return how far faults have closed the clearance within the record, m, at times (any,) in s from its start."""
    return np.asarray(sum(each.amount_m * each.ramp.share(time) for each in system.narrowings))


@dataclass(frozen=True)
class Closing:
    """The closing of the surface at the start of a run. It is opened first, so that nothing touches."""

    opening: float
    """Opening at the start, m."""
    turns: int
    """Turns after which it is closed."""

    def after(self, turns: FloatArray) -> FloatArray:
        """Return the opening in m after `turns` (any,) turns from the start; the turns must rise."""
        if turns[0] >= self.turns:
            return np.zeros(len(turns))
        return self.opening * closing_ramp(turns / self.turns)
