"""Coulomb friction of a sliding tip."""

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.contact.friction_kernels import friction_direction, slip_velocity


def sliding_friction(tip_velocity: FloatArray, casing_velocity: FloatArray, tangent: FloatArray) -> FloatArray:
    """Unit direction (3,) of the friction force on a tip, -v_rel / |v_rel| in the plane of `tangent` and e_z.

    Zero without slip. A blade tip at hundreds of m/s never sticks, so the law has no sticking. The force on the casing
    is the opposite, in its plane.

    - tip_velocity (3,): inertial, with Omega x r, m/s.
    - casing_velocity (2,): of the foot, m/s.
    - tangent (2,): unit tangent of the surface, counter-clockwise.
    """
    tip = (float(tip_velocity[0]), float(tip_velocity[1]), float(tip_velocity[2]))
    casing = (float(casing_velocity[0]), float(casing_velocity[1]))
    along, axial = friction_direction(*slip_velocity(tip, casing, (float(tangent[0]), float(tangent[1]))))
    return np.array([along * tangent[0], along * tangent[1], axial])
