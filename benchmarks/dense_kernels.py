"""The step as a competent user of numba writes it in an evening: dense matrices, loops over blades, Gauss-Seidel.

One product with [A_now A_before] (n, 2n) makes the free step. Of each blade that may be near, Newton's method finds the
foot on the piecewise cubic surface. Contacts are solved by projected Gauss-Seidel on W = N^T A^-1 F, of whose columns
only the entries of a tip and of the casing are read. No energy, no taps, no touches.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba
import numpy as np

from rubgen.arrays import FloatArray, IntArray

NEWTON_STEPS = 12
NEWTON_TOLERANCE = 1e-10
NEAR = 1e-3
"""Blades with a larger gap in m after the free step cannot touch in it."""
SWEEPS = 2000
SWEEP_TOLERANCE = 1e-13


class Dense(NamedTuple):
    """Constants of one system; n coordinates, m blades, c casing modes, k nodes."""

    free: FloatArray  # (n, 2n), [A^-1 (2 M / dt^2 - K), A^-1 (C / 2 dt - M / dt^2)]
    constant: FloatArray  # (n,), A^-1 f
    columns: FloatArray  # (n, n), the columns of A^-1, one a row
    cubics: FloatArray  # (k, 2, c, 4), coefficients in powers of the angle from each node
    nodal: FloatArray  # (2k, c), displacements of the nodes
    tip_static: FloatArray  # (m, 3), m
    blade_angles: FloatArray  # (m,), rad
    curve: FloatArray  # (orders, 3), amplitude in m, order, phase in rad
    numbers: FloatArray  # tip radius, mean radius of the surface, spin speed, friction, dt
    screening: bool  # whether a blade far from the undeformed surface is left out, as the numpy reference does


@numba.njit
def surface(model: Dense, psi: float) -> tuple[float, float, float]:
    """Radius of the undeformed surface and its first two derivatives by the angle."""
    r, dr, ddr = model.numbers[1], 0.0, 0.0
    for amplitude, order, phase in model.curve:
        cosine, sine = math.cos(order * (psi - phase)), math.sin(order * (psi - phase))
        r += amplitude * cosine
        dr -= amplitude * order * sine
        ddr -= amplitude * order * order * cosine
    return r, dr, ddr


@numba.njit
def foot(model: Dense, casing: FloatArray, x: float, y: float) -> tuple[float, float, float, float]:
    """Angle of the foot of (x, y) on the deformed surface, gap in m, and the tangent there."""
    nodes = len(model.cubics)
    h = 2 * math.pi / nodes
    psi = math.atan2(y, x)
    u, du, ddu = np.zeros(2), np.zeros(2), np.zeros(2)
    tx = ty = ax = ay = 0.0
    for _ in range(NEWTON_STEPS):
        node = math.floor(psi / h)
        s = psi - node * h
        piece = model.cubics[node % nodes]
        for axis in range(2):
            a = b = c = d = 0.0
            for mode in range(len(casing)):
                q, terms = casing[mode], piece[axis, mode]
                a += terms[0] * q
                b += terms[1] * q
                c += terms[2] * q
                d += terms[3] * q
            u[axis] = a + s * (b + s * (c + s * d))
            du[axis] = b + s * (2 * c + 3 * s * d)
            ddu[axis] = 2 * c + 6 * s * d
        r, dr, ddr = surface(model, psi)
        cosine, sine = math.cos(psi), math.sin(psi)
        ax, ay = x - r * cosine - u[0], y - r * sine - u[1]
        tx, ty = dr * cosine - r * sine + du[0], dr * sine + r * cosine + du[1]
        bx = (ddr - r) * cosine - 2 * dr * sine + ddu[0]
        by = (ddr - r) * sine + 2 * dr * cosine + ddu[1]
        change = (ax * tx + ay * ty) / (tx * tx + ty * ty - ax * bx - ay * by)
        if abs(change) < NEWTON_TOLERANCE:
            break
        psi += change
    length = math.hypot(tx, ty)
    tx, ty = tx / length, ty / length
    return psi, tx * ay - ty * ax, tx, ty


@numba.njit
def column(
    model: Dense, blade: int, psi: float, theta: float, fx: float, fy: float, axial: float, values: FloatArray
) -> None:
    """Entries (3 + c,) of the column of a force (fx, fy, axial) on a tip and its reaction on the casing."""
    nodes = len(model.cubics)
    h = 2 * math.pi / nodes
    cosine, sine = math.cos(theta + model.blade_angles[blade]), math.sin(theta + model.blade_angles[blade])
    values[0], values[1], values[2] = fx * cosine + fy * sine, fy * cosine - fx * sine, axial
    node = math.floor(psi / h)
    s = psi - node * h
    piece = model.cubics[node % nodes]
    for mode in range(piece.shape[1]):
        x, y = piece[0, mode], piece[1, mode]
        shape_x = x[0] + s * (x[1] + s * (x[2] + s * x[3]))
        shape_y = y[0] + s * (y[1] + s * (y[2] + s * y[3]))
        values[3 + mode] = -(shape_x * fx + shape_y * fy)


@numba.njit
def dense_step(model: Dense, theta: float, q: FloatArray, after: FloatArray) -> int:
    """Set `after` (n,) from `q` (2n,), which is q_n and q_n-1; `theta` is the angle at step n + 1.

    Return how many blades touch.
    """
    n, m, c = len(after), len(model.tip_static), model.cubics.shape[2]
    radius, mean = model.numbers[0], model.numbers[1]
    after[:] = np.dot(model.free, q) + model.constant
    casing = after[n - c :].copy()
    reach = 0.0
    if model.screening:
        moved = np.dot(model.nodal, casing)
        reach = 1.2 * math.sqrt(np.max(moved[0::2] ** 2 + moved[1::2] ** 2)) + 3e-4
    blades, feet, count, least = np.zeros(m, dtype=np.int64), np.zeros((m, 4)), 0, 1.0
    for blade in range(m):
        r = after[3 * blade] + model.tip_static[blade, 0] + radius
        v = after[3 * blade + 1] + model.tip_static[blade, 1]
        angle = theta + model.blade_angles[blade]
        if model.screening:
            at, clearance = angle + v / r, mean - math.hypot(r, v)
            for amplitude, order, phase in model.curve:
                clearance += amplitude * math.cos(order * (at - phase))
            if clearance >= reach:
                continue
        cosine, sine = math.cos(angle), math.sin(angle)
        psi, gap, tx, ty = foot(model, casing, r * cosine - v * sine, r * sine + v * cosine)
        least = min(least, gap)
        if gap < NEAR:
            blades[count] = blade
            feet[count] = psi, gap, tx, ty
            count += 1
    return _push(model, theta, blades[:count], feet[:count], q, after) if least < 0 else 0


@numba.njit
def _push(model: Dense, theta: float, blades: IntArray, feet: FloatArray, q: FloatArray, after: FloatArray) -> int:
    """Solve for the contact forces at the feet (count, 4) and add their response to `after`; how many act."""
    n, c, count = len(after), model.cubics.shape[2], len(blades)
    omega, friction, dt = model.numbers[2], model.numbers[3], model.numbers[4]
    rates = (after - q[n:]) / (2 * dt)
    normal, full, response = np.zeros((count, 3 + c)), np.zeros((count, 3 + c)), np.zeros((count, n))
    for k in range(count):
        blade, tip = blades[k], 3 * blades[k]
        psi, _, tx, ty = feet[k]
        angle = theta + model.blade_angles[blade]
        cosine, sine = math.cos(angle), math.sin(angle)
        out = rates[tip] - omega * (after[tip + 1] + model.tip_static[blade, 1])
        along = rates[tip + 1] + omega * (after[tip] + model.tip_static[blade, 0] + model.numbers[0])
        column(model, blade, psi, theta, tx, ty, 0.0, normal[k])
        slip = (out * cosine - along * sine) * tx + (out * sine + along * cosine) * ty
        slip += np.sum(normal[k, 3:] * rates[n - c :])
        size = math.hypot(slip, rates[tip + 2])
        around, axial = -slip / size, -rates[tip + 2] / size
        column(model, blade, psi, theta, -ty, tx, 0.0, normal[k])
        fx, fy = -ty + friction * around * tx, tx + friction * around * ty
        column(model, blade, psi, theta, fx, fy, friction * axial, full[k])
        for i in range(3):
            response[k] += full[k, i] * model.columns[tip + i]
        for mode in range(c):
            response[k] += full[k, 3 + mode] * model.columns[n - c + mode]
    W = np.zeros((count, count))
    for i in range(count):
        for k in range(count):
            at = response[k, 3 * blades[i] : 3 * blades[i] + 3]
            W[i, k] = np.sum(normal[i, :3] * at) + np.sum(normal[i, 3:] * response[k, n - c :])
    lam = np.zeros(count)
    for _ in range(SWEEPS):
        moved, largest = 0.0, 0.0
        for i in range(count):
            value = max(0.0, lam[i] - (feet[i, 1] + np.sum(W[i] * lam)) / W[i, i])
            moved, largest = max(moved, abs(value - lam[i])), max(largest, value)
            lam[i] = value
        if moved <= SWEEP_TOLERANCE * largest:
            break
    for k in range(count):
        if lam[k] > 0:
            after += lam[k] * response[k]
    return int(np.sum(lam > 0))


@numba.njit
def run(model: Dense, start_angle: float, first: int, steps: int, turn_steps: int, q: FloatArray) -> int:
    """So many steps from number `first` of a turn of `turn_steps`; how many had contact. `q` (2n,) is q_n, q_n-1."""
    n = len(q) // 2
    after, touched = np.zeros(n), 0
    for index in range(first, first + steps):
        theta = start_angle + 2 * math.pi * (index + 1) / turn_steps
        touched += dense_step(model, theta, q, after) > 0
        q[n:] = q[:n]
        q[:n] = after
    return touched
