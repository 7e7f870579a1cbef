"""Compute growth or decay of small disturbances of the rub-free motion, with uneven supports or a squeeze film.

O_d is the disk centre. E selects its x and y among the coordinates, u and v are its displacement and velocity.
"""

import math
from dataclasses import replace

import numpy as np
import scipy.linalg as la

from rubgen.arrays import ComplexArray, FloatArray, IntArray
from rubgen.reduction.model import SpinningSystem, TurningForces
from rubgen.solver.linear.rub_free import rub_free_motion
from rubgen.solver.linear.system_blocks import system_blocks
from rubgen.solver.supports.turning_forces import force_derivatives


def linearised(system: SpinningSystem) -> SpinningSystem:
    """Return the system with the laws of its support linearised at its rub-free motion, which must be static.

    C += -d f / d v and K += -d f / d u on O_d, with f the force of the laws. The result has no turning forces. A system
    without turning forces is returned unchanged.
    """
    forces = system.turning
    if forces is None:
        return system
    centre = slice(system.centre, system.centre + 2)
    u = rub_free_motion(system).at(0.0)[centre]
    by_u, by_v = force_derivatives(forces, system.speed, np.zeros(()), u, np.zeros(2))
    C, K = system.C.copy(), system.K.copy()
    C[centre, centre] -= by_v
    K[centre, centre] -= by_u
    return replace(system, C=C, K=K, turning=None)


def floquet_exponents(system: SpinningSystem, steps: int) -> ComplexArray:
    """Return exponents ln(mu) / T in 1/s of the coordinates that O_d moves, then eigenvalues of all others: 2 n values.

    mu are the eigenvalues of the transition over one period T: M q'' + C q' + K q = E (f_u u + f_v v), with the
    derivatives of the turning forces along the rub-free motion. T is half a turn, or a whole turn with laws of the
    support. The transition uses the scheme's own steps, `steps` a turn (even). Imaginary parts are known up to a
    multiple of 2 pi / T. Raises ValueError for a system without turning forces.
    """
    forces = system.turning
    if forces is None:
        raise ValueError("a system without turning forces has eigenvalues, no Floquet exponents")
    blocks = system_blocks(system)
    inside = blocks.connected(np.array([system.centre, system.centre + 1]))
    others = np.setdiff1d(np.arange(len(system.M)), inside)
    y = [blocks.transform.T @ matrix @ blocks.transform for matrix in (system.M, system.C, system.K)]
    count = steps if forces.laws else steps // 2
    transition = _transition(system, forces, [matrix[np.ix_(inside, inside)] for matrix in y], inside, count, steps)
    multipliers = la.eigvals(transition).astype(np.complex128)
    period = 2 * math.pi / system.speed * count / steps
    least = np.finfo(np.float64).tiny
    exponents = (np.log(np.maximum(np.abs(multipliers), least)) + 1j * np.angle(multipliers)) / period
    return np.concatenate([exponents, quadratic_eigenvalues(*(matrix[np.ix_(others, others)] for matrix in y))])


def quadratic_eigenvalues(M: FloatArray, C: FloatArray, K: FloatArray) -> ComplexArray:
    """Return all 2 n eigenvalues s (1/s) of s^2 M + s C + K (any, 2 n), from the first-order form.

    The matrices are (any, n, n).
    """
    zero, one = np.zeros_like(M), np.broadcast_to(np.eye(M.shape[-1]), M.shape)
    first_order = np.block([[zero, one], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    return np.asarray(np.linalg.eigvals(first_order), dtype=np.complex128)


def _transition(
    system: SpinningSystem,
    forces: TurningForces,
    matrices: list[FloatArray],
    inside: IntArray,
    count: int,
    steps: int,
) -> FloatArray:
    """Return the matrix that takes [q_n-1, q_n] through `count` steps from theta = 0.

    The matrices M, C, K are in the coordinates `inside`.
    """
    M, C, K = matrices
    n, dt = len(M), 2 * math.pi / system.speed / steps
    centre = np.searchsorted(inside, [system.centre, system.centre + 1])
    inverse = la.inv(M / dt**2 + C / (2 * dt))
    now, before = inverse @ (2 * M / dt**2 - K), inverse @ (C / (2 * dt) - M / dt**2)
    columns, Y = inverse[:, centre], inverse[np.ix_(centre, centre)]
    old, new = np.eye(2 * n)[:n], np.eye(2 * n)[n:]
    for by_u, by_v in zip(*_derivatives(system, forces, count, steps), strict=True):
        after = now @ new + before @ old
        push = by_u @ new[centre] + by_v @ (after[centre] - old[centre]) / (2 * dt)
        after += columns @ la.solve(np.eye(2) - by_v @ Y / (2 * dt), push)
        old, new = new, after
    return np.concatenate([old, new])


def _derivatives(
    system: SpinningSystem, forces: TurningForces, count: int, steps: int
) -> tuple[FloatArray, FloatArray]:
    """Return the derivatives f_u and f_v (count, 2, 2) at each step along the rub-free motion."""
    theta = 2 * np.pi * np.arange(count) / steps
    if all(
        law.LINEAR for law in forces.laws
    ):  # linear: the motion does not matter, and an undamped one may be infinite
        return force_derivatives(forces, system.speed, theta, *np.zeros((2, count, 2)))
    centre = slice(system.centre, system.centre + 2)
    q = rub_free_motion(system).harmonics[:, centre]
    orders = np.arange(len(q))
    turn = np.exp(1j * np.multiply.outer(theta, orders))
    u, v = (turn @ q).real, (turn @ (1j * system.speed * orders[:, None] * q)).real
    return force_derivatives(forces, system.speed, theta, u, v)
