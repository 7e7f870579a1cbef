"""Check the energy identity of the scheme over a run."""

from typing import Any

import numpy as np

from rubgen.contact.liner_kernels import WORK
from rubgen.solver.response import EnergyBalance
from rubgen.solver.scheme.energy_kernels import (
    ABSOLUTE,
    CIRCULATORY,
    CONTACT,
    DAMPING,
    FRICTION,
    NORMAL,
    SPEED_CHANGE,
    UNBALANCE,
)
from rubgen.solver.scheme.stepper import Stepper
from rubgen.solver.supports.support_kernels import ANISOTROPY, GRAVITY, LAWS, LAWS_LOSS, LOADS

ROUNDING_SHARE = 1e-6
"""Energies below this share of their summed absolute terms are rounding errors."""


class EnergyIdentity:
    """Measures how well a stepper satisfies the energy identity, from the creation of this object on.

    The stepper's works must be zero at the creation.
    """

    def __init__(self, stepper: Stepper) -> None:
        self.stepper, self.start_energy = stepper, stepper.energy()
        self.largest_energy = abs(self.start_energy)
        self.rounding_energy = ROUNDING_SHARE * gross_energy(stepper)

    def residual(self) -> float:
        """Return |E - E_start - works| over the sum of the absolute works, at the end of the last turn.

        A turn must have been run since the creation of this object. If the sum of the absolute works is smaller than
        the rounding error of the energy or the largest |E| at any call so far, the larger of these two is the divisor.
        At a critical speed the rub-free motion has no energy in the turning frame: there the rounding error is the
        scale.
        """
        works, energy = self.stepper.end.works, float(self.stepper.end.energy)
        self.largest_energy = max(self.largest_energy, abs(energy))
        done = works[UNBALANCE] + works[DAMPING] + works[CIRCULATORY] + works[CONTACT] + works[SPEED_CHANGE]
        done += self.stepper.end.support_works[:LAWS_LOSS].sum()
        scale = max(float(works[ABSOLUTE]), self.largest_energy, self.rounding_energy)
        return abs(energy - self.start_energy - float(done)) / scale if scale > 0 else 0.0

    def result(self, times: float = 1.0) -> dict[str, Any]:
        """Return the field `energy`, the `EnergyBalance` of a run. Works are multiplied by `times`.

        `times` is the number of the run's turns for each turn of the stepper, above 1 if one turn is repeated.
        """
        works = [times * float(work) for work in self.stepper.state.works]
        support = [times * float(work) for work in self.stepper.state.support.works]
        wear = 0.0 - float(self.stepper.state.wear.sums[WORK])
        energy = EnergyBalance(
            start=self.start_energy,
            end=self.stepper.energy(),
            unbalance=works[UNBALANCE],
            damping=works[DAMPING],
            circulatory=works[CIRCULATORY],
            anisotropy=support[ANISOTROPY],
            support_laws=support[LAWS],
            gravity=support[GRAVITY],
            faults=support[LOADS],
            contact=works[CONTACT],
            normal_loss=works[NORMAL],
            friction_loss=works[FRICTION],
            wear_loss=wear,
            support_laws_loss=support[LAWS_LOSS],
            speed_change=works[SPEED_CHANGE],
            absolute_work=works[ABSOLUTE],
            residual=self.residual(),
        )
        return {"energy": energy}


def gross_energy(stepper: Stepper) -> float:
    """Return the sum of |q_i K_ij q_j| / 2 in the present state, J: the size of the terms that cancel in the energy."""
    q = np.abs(stepper.coordinates.now)
    return 0.5 * float(q @ np.abs(stepper.system.K) @ q)
