"""Compute the forces that no constant matrix contains: uneven supports, laws of the support, gravity, faults.

It is plain numpy. `support_kernels` applies the same law in the steps of a run. O_d is the disk centre. k_a, c_a, Q and
v_abs are as in `TurningForces`.
"""

import numpy as np

from rubgen.arrays import AnyArray, FloatArray
from rubgen.reduction.model import TurningForces


def turning_force(forces: TurningForces, speed: float, theta: AnyArray, u: AnyArray, v: AnyArray) -> AnyArray:
    """Return the force (..., 2) in N on O_d in the turning frame: -k_a Q u - c_a Q v_abs and the laws of the support.

    v_abs = v + Omega e_z x u. O_d is the disk centre. k_a = (k_X - k_Y) / 2 and c_a = (c_X - c_Y) / 2 are of the
    supports. Q = [[cos 2 theta, -sin 2 theta], [-sin 2 theta, -cos 2 theta]]. Gravity and loads of faults are not
    contained. The force is piecewise analytic, so that complex steps differentiate it.

    - forces: constants of the forces.
    - speed: Omega, rad/s.
    - theta (...): angle of the blisk, rad.
    - u, v (..., 2): displacement of O_d, m, and its rate of change as seen in the turning frame, m/s.
    """
    absolute = v + speed * np.stack([-u[..., 1], u[..., 0]], axis=-1)
    f = -_uneven(theta, forces.stiffness * u + forces.damping * absolute)
    for law in forces.laws:
        f = f + law.force(theta, u, absolute)
    return np.asarray(f)


def force_derivatives(
    forces: TurningForces, speed: float, theta: FloatArray, u: FloatArray, v: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the derivatives by u and by v (..., 2, 2) of `turning_force`, by a complex step.

    Entry [..., i, j] is d f_i / d u_j, or d f_i / d v_j. The parameters are as in `turning_force`.
    """
    by_u, by_v = [], []
    for i in range(2):
        step = 1e-30j * np.eye(2)[i]
        by_u.append(turning_force(forces, speed, theta, u + step, v + 0j).imag / 1e-30)
        by_v.append(turning_force(forces, speed, theta, u + 0j, v + step).imag / 1e-30)
    return np.stack(by_u, axis=-1), np.stack(by_v, axis=-1)


def gravity_force(forces: TurningForces, theta: float) -> FloatArray | float:
    """Return the weight (n,) in N in the turning frame, along -Y: -g M T (sin theta, cos theta); 0 without gravity.

    `theta` is the angle of the blisk, rad.
    """
    return 0.0 if forces.weight is None else -forces.weight @ np.array([np.sin(theta), np.cos(theta)])


def fault_force(forces: TurningForces, theta: float) -> FloatArray | float:
    """Return the steady loads of faults on O_d (2,) in N, in the turning frame; 0 without loads. `theta` is in rad."""
    if forces.loads is None:
        return 0.0
    return np.asarray((np.exp(1j * theta * np.arange(len(forces.loads))) @ forces.loads).real)


def _uneven(theta: AnyArray, w: AnyArray) -> AnyArray:
    """Return Q(theta) w of (..., 2)."""
    c, s = np.cos(2 * theta), np.sin(2 * theta)
    return np.stack([c * w[..., 0] - s * w[..., 1], -s * w[..., 0] - c * w[..., 1]], axis=-1)
