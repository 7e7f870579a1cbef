"""Record the states after each Nth of a turn. They are equal for a motion with the symmetry of the casing."""

import math
from typing import Any

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.reduction.model import SpinningSystem
from rubgen.solver.observers.observer import Observer
from rubgen.solver.scheme.stepper import Stepper


def lobes_of(system: SpinningSystem) -> int:
    """Return the number N of lobes: the casing is unchanged by a rotation of 1/N turn.

    It is 1 for a round surface. It is also 1 where this rotation does not bring the casing's nodes onto nodes.
    """
    orders = [round(order) for order, a in zip(system.surface.order, system.surface.amplitude, strict=True) if a]
    lobes = math.gcd(*orders)
    return lobes if lobes and len(system.casing_modes) % lobes == 0 else 1


def turned_back(modes: FloatArray, share: float) -> FloatArray:
    """Return the matrix (n_casing, n_casing) that turns the casing's displacement back by a share of a turn.

    The result is R(-a) u(theta + a), with a = 2 pi `share` and u(theta) the displacement in X and Y, expressed in the
    casing's own `modes` (nodes, 2, n_casing) by least squares over the nodes. The share must bring nodes onto nodes.
    Exact where the modes of each order come in pairs.
    """
    angle, nodes = 2 * np.pi * share, len(modes)
    R = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    turned = np.einsum("ab,nbm->nam", R, np.roll(modes, -round(share * nodes), axis=0))
    flat = modes.reshape(2 * nodes, -1)
    return np.asarray(np.linalg.lstsq(flat, turned.reshape(2 * nodes, -1))[0])


class Symmetry(Observer):
    """Takes the states after 1/N, 2/N, ... 1 of the last turn, N lobes. The stepper must take snapshots at `steps`."""

    def __init__(self, stepper: Stepper) -> None:
        self.stepper, steps = stepper, stepper.steps
        lobes = lobes_of(stepper.system) if steps >= 2 else 1
        self.shares = [part / lobes for part in range(1, lobes + 1)]
        self.places = [part * steps / lobes for part in range(1, lobes + 1)]
        self.steps = sorted({min(math.ceil(place), steps) for place in self.places})

    def result(self) -> dict[str, Any]:
        """Return the field `symmetry_states` (N, 2, n): q and v, m and m/s, in the coordinates of `SpinningSystem`.

        The blisk's coordinates are in its turning frame. The casing's are turned back by the same share of a turn, so
        that a motion with the symmetry of the casing has N equal states. q is interpolated linearly between the two
        steps around the time, and v is their difference over the time step.
        """
        stepper, states = self.stepper, []
        for share, place in zip(self.shares, self.places, strict=True):
            step = min(math.ceil(place), stepper.steps)
            number = int(np.searchsorted(stepper.snapshots.steps, step))
            before, now = (stepper.blocks.to_q(z) for z in stepper.snapshots.z[number])
            back = np.eye(len(now))
            start = stepper.system.casing_start
            back[start:, start:] = turned_back(stepper.system.casing_modes, share)
            v = (now - before) / stepper.dt
            states.append(np.stack([back @ (now - (step - place) * stepper.dt * v), back @ v]))
        return {"symmetry_states": np.array(states)}
