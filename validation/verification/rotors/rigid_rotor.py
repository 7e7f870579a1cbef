"""A rigid rotor on lateral supports as the solver takes it, with no more than that in it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.linalg import block_diag

from rubgen.arrays import FloatArray
from rubgen.reduction import SpinningSystem, TurningForces
from validation.verification.rotors.jeffcott import jeffcott_system

OPEN = 2.0


def rigid_rotor(
    speed: float, *, mass: float, stiffness: float, damping: float, unbalance: float, forces: TurningForces
) -> SpinningSystem:
    """A mass at O_d on springs and dampers; the one "tip" stands apart on springs of its own, the ring far away. SI."""
    whirl = np.array([[0.0, -1.0], [1.0, 0.0]])
    M = mass * np.eye(2)
    C = 2 * speed * mass * whirl + damping * np.eye(2)
    K = (stiffness - speed**2 * mass) * np.eye(2) + speed * damping * whirl
    ring, idle = jeffcott_system(), np.eye(3)
    force = np.zeros(7)
    force[3] = unbalance * speed**2
    return replace(
        ring,
        speed=speed,
        M=block_diag(idle, M, ring.M[5:, 5:]),
        C=block_diag(1000 * idle, C, ring.C[5:, 5:]),
        K=block_diag(1e6 * idle, K, ring.K[5:, 5:]),
        force=force,
        surface=replace(ring.surface, mean_radius=OPEN),
        lateral_stiffness=stiffness,
        lateral_damping=damping,
        turning=forces,
    )


def weight_of(mass: float, gravity: float) -> FloatArray:
    """`TurningForces.weight` (7, 2) of the rotor."""
    weight = np.zeros((7, 2))
    weight[3:5] = gravity * mass * np.eye(2)
    return weight
