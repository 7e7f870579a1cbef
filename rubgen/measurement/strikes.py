"""Compute the forces of the blows that faults give the frame."""

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.machine.faults.fault import Strikes


def force_of(strikes: Strikes, turned: FloatArray, dt: float) -> tuple[FloatArray, FloatArray]:
    """Compute the forces (steps,) of blows along X and along Y in N.

    The forces are linear between the steps and keep the impulse and the time of each blow. A blow of impulse J at the
    time (n + s) dt is the force (1 - s) J / dt at step n and s J / dt at step n + 1.

    - strikes: the blows; blows outside of the steps are left out.
    - turned (steps,): angle of the shaft at the steps, rad, rising, counted as `strikes.turned`.
    - dt: time step, s.
    """
    inside = (strikes.turned >= turned[0]) & (strikes.turned < turned[-1])
    place = np.interp(strikes.turned[inside], turned, np.arange(turned.size))
    step = np.minimum(place.astype(np.int64), turned.size - 2)
    share, impulse, direction = place - step, strikes.impulse_n_s[inside], strikes.direction_rad[inside]
    forces = np.zeros((2, turned.size))
    for axis, along in enumerate((np.cos(direction), np.sin(direction))):
        np.add.at(forces[axis], step, (1 - share) * along * impulse / dt)
        np.add.at(forces[axis], step + 1, share * along * impulse / dt)
    return forces[0], forces[1]
