"""Turning forces for the kernels, and the same law in plain numpy."""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

from rubgen.arrays import AnyArray, FloatArray
from rubgen.reduction.model import SpinningSystem, TurningForces
from rubgen.solver.blocks import Blocks, aligned
from rubgen.solver.support_kernels import Support


def turning_force(forces: TurningForces, speed: float, theta: AnyArray, u: AnyArray, v: AnyArray) -> AnyArray:
    """Force (..., 2) in N on O_d in the turning frame, of its displacement u and velocity v (..., 2) at `theta` (...).

    -k_a Q u - c_a Q v_abs - C(u) v_abs, C = C_0 (1 - eps^2)^(-3/2) [1 + 3 u u^T / (c^2 (1 - eps^2))], whose
    values along and across u are the C_rr and C_tt of `machine.SqueezeFilm`. Analytic: complex steps give derivatives.
    """
    absolute = v + speed * np.stack([-u[..., 1], u[..., 0]], axis=-1)
    f = -_uneven(theta, forces.stiffness * u + forces.damping * absolute)
    if forces.film is not None:
        square = forces.film.clearance_m**2
        rest = 1 - np.sum(u * u, axis=-1, keepdims=True) / square
        along = 3 * u * np.sum(u * absolute, axis=-1, keepdims=True) / (square * rest)
        f = f - forces.film.centred_damping_n_s_per_m * rest**-1.5 * (absolute + along)
    return np.asarray(f)


def force_derivatives(
    forces: TurningForces, speed: float, theta: FloatArray, u: FloatArray, v: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Derivatives by u and by v (..., 2, 2) of `turning_force`, by a complex step."""
    by_u, by_v = [], []
    for i in range(2):
        step = 1e-30j * np.eye(2)[i]
        by_u.append(turning_force(forces, speed, theta, u + step, v + 0j).imag / 1e-30)
        by_v.append(turning_force(forces, speed, theta, u + 0j, v + step).imag / 1e-30)
    return np.stack(by_u, axis=-1), np.stack(by_v, axis=-1)


def gravity_force(forces: TurningForces, theta: float) -> FloatArray | float:
    """Weight (n,) in N in the turning frame, along -Y: -g M T (sin theta, cos theta); 0 without gravity."""
    return 0.0 if forces.weight is None else -forces.weight @ np.array([np.sin(theta), np.cos(theta)])


def support_of(system: SpinningSystem, blocks: Blocks, dt: float) -> Support:
    """The system's turning forces for a step of dt; not active where it has none."""
    forces = system.turning
    if forces is None:
        return _support(TurningForces(), active=False)
    n, tips = len(system.M), 3 * system.n_blades
    centre = np.array([system.centre, system.centre + 1])
    weight = np.zeros((n, 2)) if forces.weight is None else forces.weight
    loads = np.column_stack([np.eye(n)[:, centre], -weight])
    A = system.M / dt**2 + system.C / (2 * dt)
    columns, rows = la.solve(A, loads), la.solve(A.T, loads[:, :2])
    moved = blocks.connected(centre)
    return _support(
        forces,
        active=True,
        centre=blocks.place[centre],
        places=blocks.place[moved],
        columns=(blocks.transform.T @ columns)[moved],
        weight=(blocks.transform.T @ weight)[moved],
        compliance=columns[centre, :2],
        rows=np.stack([blocks.to_z(row) for row in rows.T]),
        tip_columns=columns[:tips, :2],
        tip_rows=rows[:tips],
    )


def _support(
    forces: TurningForces,
    *,
    active: bool,
    centre: AnyArray | None = None,
    places: AnyArray | None = None,
    **arrays: FloatArray,
) -> Support:
    """The kernels' record; arrays that are not given are empty."""
    film, none = forces.film, np.zeros(0, dtype=np.int64)
    empty = np.zeros((0, 2))
    names = ("columns", "weight", "compliance", "rows", "tip_columns", "tip_rows")
    given = {name: aligned(arrays.get(name, empty)) for name in names}
    return Support(
        active=active,
        stiffness=forces.stiffness,
        damping=forces.damping,
        film=film.centred_damping_n_s_per_m if film else 0.0,
        clearance=film.clearance_m if film else np.inf,
        centre=none if centre is None else centre,
        places=none if places is None else places,
        **given,
        drag=np.zeros((2, 2)),
        yielding=np.zeros((2, 2)),
        force=np.zeros((2, 2)),
        works=np.zeros(4),
    )


def _uneven(theta: AnyArray, w: AnyArray) -> AnyArray:
    """Q(theta) w of (..., 2)."""
    c, s = np.cos(2 * theta), np.sin(2 * theta)
    return np.stack([c * w[..., 0] - s * w[..., 1], -s * w[..., 0] - c * w[..., 1]], axis=-1)
