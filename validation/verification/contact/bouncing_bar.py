"""An elastic bar that bounces off a wall.

E = 900, rho = 1, L = 10, A = 1, speed 10. From d'Alembert's waves follow a plateau of rho c v0 A = 300, a contact
time of 2 L / c and a rebound as fast as the impact. The bar has 400 elements with lumped masses. Their dispersion
leaves some momentum behind the front. So the errors of impulse (0.24 %), contact time and rebound fall by 1.6 with
each halving of the elements, the order 2/3 of a dispersed front. The first peak of the multiplier is the momentum
of the end node divided by dt. It grows as 1/dt without a limit: only impulse and plateau have a meaning.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray
from validation.verification.contact.wall import Wall
from validation.verification.row import Row, relative

TITLE = "Bouncing bar"
E, RHO, LENGTH, AREA, SPEED = 900.0, 1.0, 10.0, 1.0, 10.0
WAVE = float(np.sqrt(E / RHO))
DURATION = 2 * LENGTH / WAVE
ELEMENTS = 400


@dataclass(frozen=True)
class Bounce:
    """Contact force (steps,) at steps of `dt`, and the bar's mean speed in the end."""

    dt: float
    force: FloatArray
    rebound: float

    @property
    def plateau(self) -> float:
        """Mean force between a tenth and nine tenths of the contact time."""
        time = self.dt * np.arange(len(self.force))
        return float(self.force[(time > 0.1 * DURATION) & (time < 0.9 * DURATION)].mean())

    @property
    def impulse(self) -> float:
        """Time integral of the force."""
        return float(self.force.sum() * self.dt)

    @property
    def contact_time(self) -> float:
        """From the first step with force to the last."""
        touching = np.flatnonzero(self.force)
        return float(self.dt * (touching[-1] - touching[0] + 1))


def bounce(elements: int, courant: float = 0.5) -> Bounce:
    """The bar, moving at the wall, over twice the contact time; `courant` is c dt over the element length."""
    h = LENGTH / elements
    masses = np.full(elements + 1, RHO * AREA * h)
    masses[[0, -1]] /= 2
    spring = E * AREA / h
    K = spring * (2 * np.eye(elements + 1) - np.eye(elements + 1, k=1) - np.eye(elements + 1, k=-1))
    K[0, 0] = K[-1, -1] = spring
    wall = Wall(np.diag(masses), K, courant * h / WAVE)
    wall.before += SPEED * wall.dt
    force = wall.run(np.zeros(int(2 * DURATION / wall.dt)))
    return Bounce(wall.dt, force, float((wall.now - wall.before) @ masses / masses.sum() / wall.dt))


def rows() -> Iterator[Row]:
    """Plateau, impulse, contact time, rebound, peaks."""
    bar, finer = bounce(ELEMENTS), bounce(ELEMENTS, courant=0.25)
    source, momentum = "d'Alembert", 2 * RHO * LENGTH * AREA * SPEED
    yield relative("bouncing bar: plateau of the contact force", source, RHO * WAVE * SPEED * AREA, bar.plateau, 1e-4)
    yield relative("bouncing bar: impulse", source, momentum, bar.impulse, 3e-3)
    yield relative("bouncing bar: contact time", source, DURATION, bar.contact_time, 3e-3)
    yield relative("bouncing bar: rebound speed", source, SPEED, bar.rebound, 6e-3)
    yield relative("bouncing bar: impulse with half the step", "with the whole step", bar.impulse, finer.impulse, 1e-3)
    for courant in (0.25, 0.125):
        coarse = bounce(100, courant)
        peak = RHO * AREA * LENGTH / 100 / 2 * SPEED / coarse.dt
        quantity = f"bouncing bar, 100 elements: first peak with dt = {courant:g} h/c"
        yield relative(quantity, "momentum of half an element over dt", peak, coarse.force.max(), 1e-6)
