"""Coulomb friction of a sliding tip."""

from __future__ import annotations

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.contact.friction_kernels import friction_direction, slip_velocity


def sliding_friction(tip_velocity: FloatArray, casing_velocity: FloatArray, tangent: FloatArray) -> FloatArray:
    """Unit direction (3,) of the friction force on a tip, -v_rel / |v_rel| in the plane of `tangent` and e_z.

    `tip_velocity` (3,) inertial, including Omega x r; `casing_velocity` (2,) of the foot; `tangent` (2,) the unit
    tangent of the surface, counter-clockwise. Zero without slip: a blade tip at hundreds of m/s never sticks, so
    sticking is no part of the law. The casing bears the opposite, in its plane.
    """
    tip = (float(tip_velocity[0]), float(tip_velocity[1]), float(tip_velocity[2]))
    casing = (float(casing_velocity[0]), float(casing_velocity[1]))
    along, axial = friction_direction(*slip_velocity(tip, casing, (float(tangent[0]), float(tangent[1]))))
    return np.array([along * tangent[0], along * tangent[1], axial])
