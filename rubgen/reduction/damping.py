"""Damping constants of a machine from its damping ratios."""

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.machine import Damping


def support_damping(damping: Damping, stiffness: FloatArray, inertia: FloatArray) -> FloatArray:
    """Dampers (6,) beside the springs of O_d, in N s/m and N m s/rad: c = 2 zeta sqrt(k m).

    `stiffness` (6,) holds the springs and `inertia` (6,) m, m, m, I_d, I_d, I_p, so zeta is the ratio of the blisk
    moving as a rigid body on that spring. The elastic mode that bears the motion has nearly the same ratio where it
    stands clear of the blades' modes. It is not used to size c because near a veering with a blade mode its modal
    mass doubles: c would double too, an artefact within the range of stiffness that data sets vary.
    """
    ratio = np.array([damping.lateral, damping.lateral, damping.axial, damping.tilt, damping.tilt, damping.torsion])
    constants: FloatArray = 2 * ratio * np.sqrt(stiffness * inertia)
    return constants


def elastic_damping(damping: Damping, blade_frequency: float) -> float:
    """Beta of the internal damping beta K_e, in s: ratio `damping.blade` at a clamped blade's first mode (rad/s)."""
    return 2 * damping.blade / blade_frequency
