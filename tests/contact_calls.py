"""Kernels of contact, called with arrays as tests have them."""

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.contact.clearance_kernels import (
    casing_displacement_bound,
    clearance_bounds,
    deformation_bounds,
    radial_margin,
    tighten,
)
from rubgen.contact.contact_kernels import friction_direction, slip_velocity
from rubgen.contact.geometry import with_zeros
from rubgen.contact.geometry_kernels import Surface, Tips, foot_of
from rubgen.contact.lcp_kernels import RIGID, SOLVED, solve_normal


def gap_and_foot(
    surface: Surface, q_casing: FloatArray, point: FloatArray, opening: float = 0.0, worn: FloatArray | None = None
) -> FloatArray:
    """Gap, foot parameter psi and the tangent's X and Y (4,) of an inertial point near the deformed surface.

    The gap in m is positive inside the casing, along the inward normal of the deformed curve. psi in rad is the polar
    angle of the foot on the undeformed curve. Valid where the point is much nearer to the surface than the radius of
    curvature.

    - surface: the casing's surface.
    - q_casing (n_casing,): the casing's coordinates.
    - point (2,): X and Y, m.
    - opening: added to the radius of the surface, m.
    - worn (bins,): coefficients of a liner's worn depth, m; unworn with None.
    """
    depth = np.zeros(0) if worn is None else worn
    psi, gap, tx, ty = foot_of(surface, depth, q_casing, opening, float(point[0]), float(point[1]), np.zeros(8))
    return np.array([gap, psi, tx, ty])


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


def solve_complementarity(W: FloatArray, b: FloatArray) -> FloatArray:
    """Lam (m,) with 0 <= lam _|_ b + W lam >= 0.

    `W` (m, m) need not be symmetric. Where its symmetric part is positive definite (friction up to about 0.3) the
    solution is unique. Projected Gauss-Seidel finds it to 1e-14 of the largest multiplier. In all other cases Lemke's
    pivoting is used. Raises ArithmeticError where both fail.
    """
    m = b.shape[0]
    lam = np.zeros(m)
    work = np.zeros((m, m)), np.zeros((m, 2 * m + 2)), np.zeros(m, dtype=np.int64)
    matrix, gap = np.ascontiguousarray(W), np.ascontiguousarray(b)
    if solve_normal(np.array([RIGID]), matrix, gap, m, lam, *work) != SOLVED:
        raise ArithmeticError(f"no contact forces found for {m} contacts")
    return lam


def screened(
    surface: Surface,
    tips: Tips,
    casing: FloatArray,
    displacement: FloatArray,
    theta: float,
    opening: float,
    margin: float,
    tip_shift: float,
) -> tuple[FloatArray, FloatArray, float, bool]:
    """Bounds (n_blades,) to the undeformed and to the deformed surface, what is enough of them, and the result.

    - casing (n_casing,), displacement (2 or more, n_blades): the casing's coordinates and the tips' displacement, m.
    - theta: angle of the blisk, rad.
    - opening, margin: in m; `tip_shift` in tip radii.
    """
    angle, blades = surface.order * (theta - surface.phase), displacement.shape[1]
    waves, moved = (np.cos(angle), np.sin(angle)), with_zeros(displacement)
    deformation = deformation_bounds(surface, casing, casing_displacement_bound(surface, casing))
    enough, bounds = radial_margin(surface, deformation, margin), np.full(moved.shape[1], np.nan)
    clearance_bounds(surface, tips, moved, opening, tip_shift, *waves, bounds)
    free = bounds.copy()
    apart = tighten(
        surface, tips, with_zeros(casing), moved, theta, *waves, opening, tip_shift, deformation, enough, bounds
    )
    assert bounds[blades:].min(initial=np.inf) > 1e5
    return free[:blades], bounds[:blades], enough, apart
