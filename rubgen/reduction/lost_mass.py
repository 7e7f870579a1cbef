"""Take masses from the tips of a reduced blisk.

M is mass, G Coriolis, K_sigma the stiffness from centrifugal stress and S spin softening, at 1 rad/s.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.machine.faults.fault import LostMass
from rubgen.reduction.blisk import ReducedBlisk

CROSS = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
"""e_z x along the axes of a tip: radial, tangential, axial."""


def without_masses(blisk: ReducedBlisk, lost: Sequence[LostMass], tip_radius: float) -> ReducedBlisk:
    """Return the blisk without some point masses at its tips. The given blisk is not changed.

    It is exact, except for the tension. M, G and A = K_sigma - S lose m, m e_z x and -m diag(1, 1, 0) on a tip, and the
    load of an angular acceleration loses m r along its tangent. The steady tension that the mass put into its blade
    stays in K_sigma.

    - lost: masses and their blades.
    - tip_radius: r, radius of the tips at rest, m.
    """
    if not lost:
        return blisk
    M, G, A, euler = blisk.M.copy(), blisk.G.copy(), blisk.A.copy(), blisk.euler.copy()
    for each in lost:
        tip = slice(3 * each.blade, 3 * each.blade + 3)
        M[tip, tip] -= each.kg * np.eye(3)
        G[tip, tip] -= each.kg * CROSS
        A[tip, tip] += each.kg * np.diag([1.0, 1.0, 0.0])
        euler[3 * each.blade + 1] -= each.kg * tip_radius
    return replace(blisk, M=M, G=G, A=A, euler=euler)


def missing_pull(lost: Sequence[LostMass], tip_radius: float, tip_static: FloatArray, size: int) -> FloatArray:
    """Return minus the centrifugal force of the lost masses at 1 rad/s, in kg m: (size,), on the tips' coordinates.

    `tip_static` (blades, 3) is the steady displacement of the tips in m, `tip_radius` their radius at rest in m. `size`
    is the number of coordinates of the result.
    """
    pull = np.zeros(size)
    for each in lost:
        radial, tangential, _ = tip_static[each.blade]
        pull[3 * each.blade] -= each.kg * (tip_radius + radial)
        pull[3 * each.blade + 1] -= each.kg * tangential
    return pull
