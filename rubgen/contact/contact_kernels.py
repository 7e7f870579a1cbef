"""Find all blades near the casing in one step, set up the problem for the contact forces, and wear the liner by them.

Geometry is evaluated at the free state q* and the angle theta of the new step. B_n lam is the normal force. B lam with
B = B_n + mu B_tau is the whole force. Both matrices have entries only at three tip coordinates and the casing modes of
each contact. A is the matrix of the time step, A q_n+1 = right side: A^-1 times a force is the displacement by which
the force changes q_n+1.
"""

import math
from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.contact.geometry_kernels import Surface, Tips, casing_rows, foot_of, tip_position
from rubgen.contact.liner_kernels import WORK, Liner, Wear, remove, worn_depth
from rubgen.jit import allocation_free_kernel, inlined_kernel
from rubgen.linalg.vector_kernels import LANES, lowest_bit, not_above, square_of_farthest


class ContactWork(NamedTuple):
    """Arrays of the contact step, allocated once. Row m of an array of contacts belongs to blade `blade[m]`."""

    casing: FloatArray
    """The casing's coordinates in q* and zeros behind, as `Surface.radial` has them."""
    bounds: FloatArray
    """Bound of each blade's clearance, and huge numbers behind the last blade to a multiple of eight, m."""
    psi: FloatArray
    """Polar angle of each blade's foot (n_blades,), rad; it need not lie in [0, 2 pi)."""
    gap: FloatArray
    """Free gap of each blade at q* (n_blades,), NaN where the blade is certainly farther than the margin, m."""
    tangent: FloatArray
    """X and Y of the tangent at each blade's foot (n_blades, 2)."""
    step_gaps: FloatArray
    """The scheme's gaps at steps n - 1, n and n + 1 (3, n_blades), NaN where not known, m. Steps leave them."""
    blade: IntArray
    """The blade of each contact (n_blades,)."""
    lam: FloatArray
    """Normal force of each contact (n_blades,), N."""
    b: FloatArray
    """Gap of each contact before the forces (n_blades,), m."""
    W: FloatArray
    """B_n^T A^-1 B (n_blades, n_blades), m/N."""
    normal_tip: FloatArray
    """B_n of each contact on its tip (n_blades, 3)."""
    full_tip: FloatArray
    """B of each contact on its tip (n_blades, 3)."""
    normal_casing: FloatArray
    """B_n of each contact on the casing (n_blades, n_casing)."""
    full_casing: FloatArray
    """B of each contact on the casing (n_blades, n_casing)."""
    slip: FloatArray
    """Direction of friction of each contact along tangent and axis (n_blades, 2)."""
    sliding: FloatArray
    """|v_rel| of each contact where friction or wear asks for it (n_blades,), m/s."""
    casing_response: FloatArray
    """A^-1 B of each contact on the casing (n_blades, n_casing)."""
    ends: FloatArray
    """Scratch of `foot_of` (8,)."""
    rows: FloatArray
    """Scratch: X and Y displacement of a point per unit of each casing mode (2, n_casing)."""
    square: FloatArray
    """Scratch of `solve_normal` (n_blades, n_blades)."""
    tableau: FloatArray
    """Scratch of `solve_normal` (n_blades, 2 n_blades + 2)."""
    basis: IntArray
    """Scratch of `solve_normal` (n_blades,)."""


@inlined_kernel
def find_near(
    surface: Surface,
    tips: Tips,
    worn: FloatArray,
    q: FloatArray,
    displacement: FloatArray,
    casing_start: int,
    opening: float,
    cos_theta: float,
    sin_theta: float,
    margin: float,
    enough: float,
    work: ContactWork,
) -> tuple[int, bool]:
    """Find the blades nearer to the surface than `margin`. Return their number, and whether any tip has entered it.

    The numbers of these blades are written into `work.blade`, ascending. `psi`, `gap` and `tangent` of `work` are
    written at the index of each such blade. The gap of every other blade is set to NaN. Only tips whose bound in
    `work.bounds` is at most `enough` are evaluated: any other is farther than `margin`.

    - worn (bins,): coefficients of the worn depth, m; (0,) without a liner.
    - q (n,): q*; radial and tangential displacement of the evaluated tips are copied into it.
    - displacement (2, n_blades or more): radial and tangential displacement of each tip, m.
    - casing_start: index of the first casing coordinate in q.
    - opening: added to the radius of the surface, m.
    - cos_theta, sin_theta: of the blisk's angle.
    - margin: in m.
    - enough: its `radial_margin`, m.
    """
    count, penetrates = 0, False
    for k in range(work.gap.shape[0]):
        work.gap[k] = math.nan
    for row in range(work.bounds.shape[0] // LANES):
        near = not_above(work.bounds, row, enough)
        while near != 0:
            k = LANES * row + lowest_bit(near)
            near &= near - 1
            q[3 * k], q[3 * k + 1] = displacement[0, k], displacement[1, k]
            x, y, _, _ = tip_position(tips, k, q, cos_theta, sin_theta)
            psi, gap, tx, ty = foot_of(surface, worn, q[casing_start:], opening, x, y, work.ends)
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
    worn: FloatArray,
    blade: int,
    q: FloatArray,
    casing_start: int,
    opening: float,
    cos_theta: float,
    sin_theta: float,
    ends_work: FloatArray,
) -> float:
    """Return the gap of one blade's tip to the deformed surface in the state q (n,), m; negative in penetration.

    - worn (bins,): coefficients of the worn depth, m; (0,) without a liner.
    - casing_start: index of the first casing coordinate in q.
    - opening: added to the radius of the surface, m.
    - cos_theta, sin_theta: cosine and sine of the blisk's angle.
    - ends_work (8,): scratch.
    """
    x, y, _, _ = tip_position(tips, blade, q, cos_theta, sin_theta)
    return foot_of(surface, worn, q[casing_start:], opening, x, y, ends_work)[1]


@allocation_free_kernel
def slip_velocity(
    tip: tuple[float, float, float], casing: tuple[float, float], tangent: tuple[float, float]
) -> tuple[float, float]:
    """Return the velocity of the tip relative to the casing along the surface's tangent and along e_z, m/s.

    `tip` (x, y, z) and `casing` (x, y) are the velocities, m/s, `tangent` (x, y) is the unit tangent, all in the
    inertial frame.
    """
    return (tip[0] - casing[0]) * tangent[0] + (tip[1] - casing[1]) * tangent[1], tip[2]


@allocation_free_kernel
def friction_direction(along: float, axial: float) -> tuple[float, float]:
    """Return the direction of Coulomb friction, -v_rel / |v_rel|, along tangent and e_z; zeros without slip.

    `along` and `axial` are the parts of the relative velocity v_rel along tangent and e_z.
    """
    speed = math.sqrt(along * along + axial * axial)
    if speed == 0.0:
        return 0.0, 0.0
    return -along / speed, -axial / speed


@inlined_kernel
def contact_slip(
    tips: Tips, m: int, velocity: FloatArray, q: FloatArray, speed: float, cosine: float, sine: float, work: ContactWork
) -> tuple[float, float]:
    """Return the velocity of the tip of contact m relative to the casing, along tangent and axis, in m/s.

    `work.rows` must contain the `casing_rows` at the contact's psi, and `work.tangent` what `find_near` writes.

    - velocity (n,): q' or a step d of q, in the coordinates' own frames. With d the result is a path in m.
    - q (n,): coordinates, m.
    - speed: Omega, rad/s, or Omega dt where `velocity` is d.
    - cosine, sine: of the blade's polar angle, theta plus its angle on the disk.
    """
    k, n_casing = work.blade[m], work.rows.shape[1]
    radial = velocity[3 * k] - speed * (tips.static[1, k] + q[3 * k + 1])
    tangential = velocity[3 * k + 1] + speed * (tips.radius + tips.static[0, k] + q[3 * k])
    casing_x, casing_y = 0.0, 0.0
    start = velocity.shape[0] - n_casing
    for j in range(n_casing):
        casing_x += work.rows[0, j] * velocity[start + j]
        casing_y += work.rows[1, j] * velocity[start + j]
    tip = (radial * cosine - tangential * sine, radial * sine + tangential * cosine, velocity[3 * k + 2])
    return slip_velocity(tip, (casing_x, casing_y), (work.tangent[k, 0], work.tangent[k, 1]))


@inlined_kernel
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
    """Write B_n and B of contact m, and the direction of its friction, into row m of `work`.

    Read are `blade`, `psi` and `tangent` of `work`, which `find_near` writes. Written are `normal_tip`, `full_tip`,
    `normal_casing`, `full_casing` and `slip`, a unit vector along tangent and axis, or 0 without slip. B_n pushes the
    tip inwards and the casing outwards. The three numbers of a tip are along its blade's radial, tangential and axial
    direction. With friction or a liner `sliding` is written too. Without both `slip` is 0. Afterwards `work.rows` has
    the `casing_rows` of this contact.

    - m: number of the contact, not of the blade.
    - q (n,), velocity (n,): free state q*, m, and its velocity, m/s. Of the tips only coordinates of this blade are
      read.
    - speed: Omega, rad/s.
    - friction: coefficient of friction, 0 for none.
    - cos_theta, sin_theta: cosine and sine of the blisk's angle at the new step.
    """
    k = work.blade[m]
    _, _, cosine, sine = tip_position(tips, k, q, cos_theta, sin_theta)
    casing_rows(surface, work.psi[k], work.rows)
    tx, ty = work.tangent[k, 0], work.tangent[k, 1]
    along, axial = 0.0, 0.0
    if friction > 0.0 or surface.liner.bins > 0:
        slip = contact_slip(tips, m, velocity, q, speed, cosine, sine, work)
        along, axial = friction_direction(slip[0], slip[1])
        work.sliding[m] = math.sqrt(slip[0] * slip[0] + slip[1] * slip[1])
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


@inlined_kernel
def build_casing_response(m: int, compliance: FloatArray, work: ContactWork) -> None:
    """Write A^-1 B of contact m on the casing into row m of `work.casing_response`.

    `work.full_casing[m]` must have been written (`build_rows`). `compliance` (n_casing, n_casing) is the casing's part
    of A^-1; row j is column j of A^-1.
    """
    n_casing = work.rows.shape[1]
    for i in range(n_casing):
        work.casing_response[m, i] = 0.0
    for j in range(n_casing):
        force = work.full_casing[m, j]
        for i in range(n_casing):
            work.casing_response[m, i] += force * compliance[j, i]


@inlined_kernel
def build_compliance(count: int, compliance: FloatArray, work: ContactWork) -> None:
    """Write W = B_n^T A^-1 B of all `count` contacts into `work.W`: the change of each gap per newton of each force.

    Rows m < `count` of `blade`, `normal_tip`, `full_tip`, `normal_casing` and `casing_response` of `work` must have
    been written (`build_rows`, `build_casing_response`). Written is `work.W[:count, :count]`, m/N; it contains tips and
    casing.

    - compliance (3 n_blades, 3 n_blades): row j is column j of A^-1 between the tip coordinates, m/N. Coordinates 3 k,
      3 k + 1 and 3 k + 2 are radial, tangential and axial of blade k.
    """
    for row in range(count):
        base = 3 * work.blade[row]
        for column in range(count):
            total, other = 0.0, 3 * work.blade[column]
            for a in range(3):
                for b in range(3):
                    force = work.normal_tip[row, a] * work.full_tip[column, b]
                    total += force * compliance[other + b, base + a]
            for j in range(work.rows.shape[1]):
                total += work.normal_casing[row, j] * work.casing_response[column, j]
            work.W[row, column] = total


@inlined_kernel
def largest_approach(
    surface: Surface,
    tips_new: FloatArray,
    tips_free: FloatArray,
    q_new: FloatArray,
    q_free: FloatArray,
    casing_start: int,
) -> float:
    """Return a bound of how much the contact forces may have closed any gap, m: movement of tip plus casing.

    - tips_new, tips_free (2, a multiple of eight): radial and tangential displacement with and without the forces, m.
    - q_new, q_free (n,): coordinates with and without the forces; only the casing's coordinates are read.
    - casing_start: index of the first casing coordinate.
    """
    tip = square_of_farthest(tips_new, tips_free)
    casing = 0.0
    for j in range(surface.mode_displacement.shape[0]):
        casing += abs(q_new[casing_start + j] - q_free[casing_start + j]) * surface.mode_displacement[j]
    return math.sqrt(tip) + casing


@inlined_kernel
def wear_where_lined(count: int, liner: Liner, dt: float, work: ContactWork, wear: Wear) -> None:
    """Wear the liner by the contacts of one step, as `wear_liner` does. Without a liner nothing is done."""
    if liner.bins > 0:
        wear_liner(count, liner, dt, work, wear)


@allocation_free_kernel
def wear_liner(count: int, liner: Liner, dt: float, work: ContactWork, wear: Wear) -> None:
    """Wear the liner by the contacts of one step: volume = rate lam |v_rel| dt at each contact's foot. Changes `wear`.

    Archard, J. Appl. Phys. 24 (1953): the worn volume is K F s / H for a force F, a path s and the hardness H;
    `liner.rate` is K / H. Before the wear, the work of the forces on the receding surface is added to `wear.sums`. The
    gaps of this step used the present depth, the gaps of two steps before `wear.earlier[0]`. In one step the surface
    has therefore receded by half the difference of the two depths. Then `wear.earlier` moves on by one step. Contacts
    without force are left out.

    - count: number of contacts in `work`, of which `blade`, `psi`, `lam` and `sliding` are read.
    - dt: time step, s.
    """
    for m in range(count):
        if work.lam[m] > 0.0:
            psi = work.psi[work.blade[m]]
            receded = worn_depth(wear.depth, psi)[0] - worn_depth(wear.earlier[0], psi)[0]
            wear.sums[WORK] += 0.5 * work.lam[m] * receded
    for i in range(liner.bins):
        wear.earlier[0, i] = wear.earlier[1, i]
        wear.earlier[1, i] = wear.depth[i]
    for m in range(count):
        if work.lam[m] > 0.0:
            remove(liner, work.psi[work.blade[m]], liner.rate * work.lam[m] * work.sliding[m] * dt, wear)
