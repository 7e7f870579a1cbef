"""All blades that are near the casing in one step, and the contact forces between them.

Geometry is taken at the free state q* and the angle theta of the new step. B_n lam is the normal force, B = B_n + mu
B_tau the whole; both have entries at three tip coordinates and the casing modes of each contact only.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.contact.friction_kernels import friction_direction, slip_velocity
from rubgen.contact.geometry_kernels import (
    Surface,
    Tips,
    casing_reach,
    casing_rows,
    foot_of,
    tip_position,
)
from rubgen.jit import allocation_free_kernel


class ContactWork(NamedTuple):
    """Arrays of the contact step, allocated once; row m of the contact arrays belongs to blade `blade[m]`.

    Per blade: `bounds`, `psi`, `gap` (the free gap at q*; NaN when the blade is provably farther than the
    margin), `tangent` (n_blades, 2), `held` (3, n_blades): the scheme's gaps at steps n - 1, n, n + 1.
    Per contact: `lam`, `b`, `W`, `normal_tip` and `full_tip` (n_blades, 3), `normal_casing` and `full_casing`
    (n_blades, n_casing), `slip` (n_blades, 2) the friction direction, `blisk_response` and `casing_response`: A^-1 B.
    """

    bounds: FloatArray
    psi: FloatArray
    gap: FloatArray
    tangent: FloatArray
    held: FloatArray
    blade: IntArray
    lam: FloatArray
    b: FloatArray
    W: FloatArray
    normal_tip: FloatArray
    full_tip: FloatArray
    normal_casing: FloatArray
    full_casing: FloatArray
    slip: FloatArray
    blisk_response: FloatArray
    casing_response: FloatArray
    ends: FloatArray
    rows: FloatArray
    square: FloatArray
    tableau: FloatArray
    basis: IntArray


@allocation_free_kernel
def find_near(
    surface: Surface,
    tips: Tips,
    q: FloatArray,
    casing_start: int,
    opening: float,
    cos_theta: float,
    sin_theta: float,
    margin: float,
    screen: bool,
    work: ContactWork,
) -> tuple[int, bool]:
    """Free gaps of all blades that may be nearer than `margin`; how many are, and whether any penetrates."""
    reach = casing_reach(surface, q[casing_start:])
    count, penetrates = 0, False
    for k in range(work.bounds.shape[0]):
        work.gap[k] = math.nan
        if screen and work.bounds[k] - reach > margin:
            continue
        x, y, _, _ = tip_position(tips, k, q, cos_theta, sin_theta)
        psi, gap, tx, ty = foot_of(surface, q[casing_start:], opening, x, y, work.ends)
        if gap >= margin:
            continue
        work.psi[k], work.gap[k] = psi, gap
        work.tangent[k, 0], work.tangent[k, 1] = tx, ty
        work.blade[count] = k
        count += 1
        penetrates = penetrates or gap < 0.0
    return count, penetrates


@allocation_free_kernel
def gap_at(
    surface: Surface,
    tips: Tips,
    blade: int,
    q: FloatArray,
    casing_start: int,
    opening: float,
    cos_theta: float,
    sin_theta: float,
    ends_work: FloatArray,
) -> float:
    """The geometric gap of one blade in a given state."""
    x, y, _, _ = tip_position(tips, blade, q, cos_theta, sin_theta)
    return foot_of(surface, q[casing_start:], opening, x, y, ends_work)[1]


@allocation_free_kernel
def contact_slip(
    tips: Tips, m: int, velocity: FloatArray, q: FloatArray, speed: float, cosine: float, sine: float, work: ContactWork
) -> tuple[float, float]:
    """Relative velocity of contact m along tangent and axis; `velocity` (n,) is q' in the coordinates' own frames."""
    k, n_casing = work.blade[m], work.rows.shape[1]
    radial = velocity[3 * k] - speed * (tips.static[k, 1] + q[3 * k + 1])
    tangential = velocity[3 * k + 1] + speed * (tips.radius + tips.static[k, 0] + q[3 * k])
    casing_x, casing_y = 0.0, 0.0
    start = velocity.shape[0] - n_casing
    for j in range(n_casing):
        casing_x += work.rows[0, j] * velocity[start + j]
        casing_y += work.rows[1, j] * velocity[start + j]
    tip = (radial * cosine - tangential * sine, radial * sine + tangential * cosine, velocity[3 * k + 2])
    return slip_velocity(tip, (casing_x, casing_y), (work.tangent[k, 0], work.tangent[k, 1]))


@allocation_free_kernel
def build_rows(
    surface: Surface,
    tips: Tips,
    m: int,
    q: FloatArray,
    velocity: FloatArray,
    speed: float,
    friction: float,
    cos_theta: float,
    sin_theta: float,
    work: ContactWork,
) -> None:
    """The normal and full force directions of contact m on its tip and on the casing modes."""
    k = work.blade[m]
    _, _, cosine, sine = tip_position(tips, k, q, cos_theta, sin_theta)
    casing_rows(surface, work.psi[k], work.rows)
    tx, ty = work.tangent[k, 0], work.tangent[k, 1]
    along, axial = 0.0, 0.0
    if friction > 0.0:
        slip = contact_slip(tips, m, velocity, q, speed, cosine, sine, work)
        along, axial = friction_direction(slip[0], slip[1])
    work.slip[m, 0], work.slip[m, 1] = along, axial
    fx, fy = -ty + friction * along * tx, tx + friction * along * ty
    work.normal_tip[m, 0] = -ty * cosine + tx * sine
    work.normal_tip[m, 1] = ty * sine + tx * cosine
    work.normal_tip[m, 2] = 0.0
    work.full_tip[m, 0] = fx * cosine + fy * sine
    work.full_tip[m, 1] = -fx * sine + fy * cosine
    work.full_tip[m, 2] = friction * axial
    for j in range(work.rows.shape[1]):
        work.normal_casing[m, j] = ty * work.rows[0, j] - tx * work.rows[1, j]
        work.full_casing[m, j] = -fx * work.rows[0, j] - fy * work.rows[1, j]


@allocation_free_kernel
def build_response(m: int, blisk_inverse: FloatArray, casing_inverse: FloatArray, work: ContactWork) -> None:
    """A^-1 B of contact m; `*_inverse[j]` is column j of the inverse of that block of A, padded."""
    base = 3 * work.blade[m]
    f0, f1, f2 = work.full_tip[m, 0], work.full_tip[m, 1], work.full_tip[m, 2]
    for i in range(blisk_inverse.shape[1]):
        work.blisk_response[m, i] = (
            f0 * blisk_inverse[base, i] + f1 * blisk_inverse[base + 1, i] + f2 * blisk_inverse[base + 2, i]
        )
    for i in range(casing_inverse.shape[1]):
        work.casing_response[m, i] = 0.0
    for j in range(casing_inverse.shape[0]):
        force = work.full_casing[m, j]
        for i in range(casing_inverse.shape[1]):
            work.casing_response[m, i] += force * casing_inverse[j, i]


@allocation_free_kernel
def build_compliance(count: int, work: ContactWork) -> None:
    """W = B_n^T A^-1 B of all contacts together."""
    for row in range(count):
        base = 3 * work.blade[row]
        for column in range(count):
            total = 0.0
            for a in range(3):
                total += work.normal_tip[row, a] * work.blisk_response[column, base + a]
            for j in range(work.rows.shape[1]):
                total += work.normal_casing[row, j] * work.casing_response[column, j]
            work.W[row, column] = total


@allocation_free_kernel
def apply_contacts(count: int, q: FloatArray, casing_start: int, work: ContactWork) -> None:
    """Q += A^-1 B lam."""
    for m in range(count):
        lam = work.lam[m]
        if lam > 0.0:
            for i in range(casing_start):
                q[i] += lam * work.blisk_response[m, i]
            for j in range(q.shape[0] - casing_start):
                q[casing_start + j] += lam * work.casing_response[m, j]


@allocation_free_kernel
def largest_approach(
    surface: Surface, q_new: FloatArray, q_free: FloatArray, casing_start: int, n_blades: int
) -> float:
    """A bound of how much the contact forces may have closed any gap: tip movement plus casing movement."""
    tip = 0.0
    for k in range(n_blades):
        radial, tangential = q_new[3 * k] - q_free[3 * k], q_new[3 * k + 1] - q_free[3 * k + 1]
        tip = max(tip, radial * radial + tangential * tangential)
    casing = 0.0
    for j in range(surface.reach.shape[0]):
        casing += abs(q_new[casing_start + j] - q_free[casing_start + j]) * surface.reach[j]
    return math.sqrt(tip) + casing
