"""A Jeffcott rotor in a rigid ring on springs, as the solver takes it, and its full annular rub in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag

from rubgen.reduction import CasingSurface, SpinningSystem

SPEED = 800.0
FRICTION = 0.1
CLEARANCE = 3e-4
ROTOR_MASS, ROTOR_STIFFNESS, ROTOR_DAMPING = 10.0, 1e7, 2000.0
STATOR_MASS, STATOR_STIFFNESS, STATOR_DAMPING = 2.0, 2e7, 1200.0
UNBALANCE = 6e-3
NODES = 12
PENALTY, DAMPING_RATIO = 1e11, 5.0
"""Of `penalty_contact`: stiffness in N/m, and damping ratio of the contact of the two masses."""


def jeffcott_system(unbalance: float = UNBALANCE, side_force: float = 0.0) -> SpinningSystem:
    """One "tip" that is the rotor's centre, in a ring whose radius is the clearance.

    A tip radius of 1 m, with a steady displacement of -1 m that takes it back to the axis, sets the scale of the
    solver's margins. Axial motion and O_d take no part. `unbalance` in kg m; `side_force` in N pushes the ring along X.
    """
    whirl = np.array([[0.0, -1.0], [1.0, 0.0]])
    drag, idle = ROTOR_DAMPING * np.eye(2), np.eye(3)
    M = ROTOR_MASS * np.eye(2)
    C = 2 * SPEED * ROTOR_MASS * whirl + drag
    K = (ROTOR_STIFFNESS - SPEED**2 * ROTOR_MASS) * np.eye(2) + SPEED * drag @ whirl
    stator = np.eye(2) / STATOR_MASS
    force = np.zeros(7)
    force[0], force[-2] = unbalance * SPEED**2, side_force / STATOR_MASS**0.5
    modes = np.zeros((NODES, 2, 2))
    modes[:] = np.eye(2) / np.sqrt(STATOR_MASS)
    return SpinningSystem(
        speed=SPEED,
        M=block_diag(M, idle, np.eye(2)),
        C=block_diag(C, 100 * idle, STATOR_DAMPING * stator),
        K=block_diag(K, 1e6 * idle, STATOR_STIFFNESS * stator),
        force=force,
        n_blades=1,
        n_casing=2,
        tip_radius=1.0,
        blade_angles=np.zeros(1),
        tip_static=np.array([[-1.0, 0.0, 0.0]]),
        surface=CasingSurface(mean_radius=CLEARANCE, amplitude=np.zeros(1), order=np.full(1, 2.0), phase=np.zeros(1)),
        casing_modes=modes,
        lateral_stiffness=1e6,
        lateral_damping=0.0,
    )


def penalty_contact(mass: float, clearance: float) -> Callable[[complex, complex], tuple[float, complex]]:
    """The contact of a rotor of that mass in the ring with a stiff penalty: what an ODE solver can take.

    It gives the normal force, and the force on the ring, for the rotor's place and velocity relative to the ring.
    """
    damper = 2 * DAMPING_RATIO * np.sqrt(PENALTY / (1 / mass + 1 / STATOR_MASS))

    def contact(z: complex, v: complex) -> tuple[float, complex]:
        if abs(z) <= clearance:
            return 0.0, 0j
        outward = z / abs(z)
        normal = max(0.0, PENALTY * (abs(z) - clearance) + damper * (v * outward.conjugate()).real)
        return normal, normal * complex(1, FRICTION) * outward

    return contact


@dataclass(frozen=True)
class AnnularRub:
    """Synchronous rub: normal force in N, rotor and stator displacement in the turning frame in m (complex)."""

    force: float
    rotor: complex
    stator: complex


def annular_rub(clearance: float = CLEARANCE) -> AnnularRub:
    """The closed form of synchronous full annular rub.

    D_r z_r = U Omega^2 - N (1 + i mu) e^(i phi), D_s z_s = N (1 + i mu) e^(i phi), z_r - z_s = c e^(i phi) with the
    dynamic stiffness D = k - m Omega^2 + i c Omega. So |D_r c + N (1 + i mu)(1 + D_r / D_s)| = U Omega^2: a quadratic
    equation in N; friction opposes the slip Omega c of the rotor's centre along the ring.
    """
    rotor = complex(ROTOR_STIFFNESS - ROTOR_MASS * SPEED**2, ROTOR_DAMPING * SPEED)
    stator = complex(STATOR_STIFFNESS - STATOR_MASS * SPEED**2, STATOR_DAMPING * SPEED)
    push = UNBALANCE * SPEED**2
    a, b = rotor * clearance, complex(1, FRICTION) * (1 + rotor / stator)
    roots = np.roots([abs(b) ** 2, 2 * (a * b.conjugate()).real, abs(a) ** 2 - push**2])
    force = float(roots.real.max())
    direction = push / (a + force * b)
    z_s = force * complex(1, FRICTION) * direction / stator
    return AnnularRub(force, z_s + clearance * direction, z_s)
