"""Forces that no constant matrix holds: uneven supports, a squeeze film damper, gravity.

On O_d, in the turning frame and at the time of step n,

    f = -k_a Q(theta_n) u_n - D v_abs,   D = c_a Q(theta_n) + C(u_n)
    v_abs = (u_n+1 - u_n-1) / (2 dt) + Omega e_z x u_n

(`reduction.model.TurningForces`). It is linear in the velocity and implicit in it, like the scheme's own dampers:
u_n+1 = u* + Y f with Y = E^T A^-1 E makes it two equations, and contact sees A + E D E^T / (2 dt) for A. So the works
of D are never positive where D is not negative, whatever the contact does in the same step.
"""

from __future__ import annotations

from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.contact.contact_kernels import ContactWork
from rubgen.jit import inlined_kernel
from rubgen.linalg.lanes_kernels import dot_rows
from rubgen.linalg.vector_kernels import LANES

ANISOTROPY, FILM, GRAVITY, FILM_LOSS = range(4)


class Support(NamedTuple):
    """The forces' constants, what A^-1 makes of them, and what a step keeps.

    `film` C_0 in N s/m and its `clearance` in m. `centre` (2,) the numbers of z of O_d; `places` (m,) those which a
    force there or the weight can move, where stand `columns` (m, 4), A^-1 times unit forces on O_d x, y and minus the
    weight's sin and cos part, and `weight` (m, 2) itself. `compliance` (2, 2) is Y; `rows` (2, numbers of z) E^T A^-1;
    `tip_columns`, `tip_rows` (3 blades, 2) A^-1 E at the tips and its like from there.
    Kept: `drag` (2, 2) and `yielding` (2, 2): D and (1 + D Y / 2 dt)^-1 D / 2 dt; `force` (2, 2): f without and with
    contact; `works` (4,).
    """

    active: bool
    stiffness: float
    damping: float
    film: float
    clearance: float
    centre: IntArray
    places: IntArray
    columns: FloatArray
    weight: FloatArray
    compliance: FloatArray
    rows: FloatArray
    tip_columns: FloatArray
    tip_rows: FloatArray
    drag: FloatArray
    yielding: FloatArray
    force: FloatArray
    works: FloatArray


@inlined_kernel
def turned(cosine: float, sine: float, x: float, y: float) -> tuple[float, float]:
    """Q(theta) (x, y) from cos theta and sin theta."""
    double_cosine, double_sine = cosine * cosine - sine * sine, 2.0 * cosine * sine
    return double_cosine * x - double_sine * y, -double_sine * x - double_cosine * y


@inlined_kernel
def build_drag(support: Support, cosine: float, sine: float, x: float, y: float, dt: float) -> None:
    """`drag` D at u = (x, y) and `yielding` (1 + D Y / 2 dt)^-1 D / 2 dt."""
    D, Y = support.drag, support.compliance
    for i in range(2):
        D[0, i], D[1, i] = turned(cosine, sine, 1.0 - i, float(i))
        D[0, i] *= support.damping
        D[1, i] *= support.damping
    if support.film > 0.0:
        rest = 1.0 - (x * x + y * y) / (support.clearance * support.clearance)
        even = support.film / (rest * rest**0.5)
        along = 3.0 * even / (rest * support.clearance * support.clearance)
        D[0, 0] += even + along * x * x
        D[0, 1] += along * x * y
        D[1, 0] += along * x * y
        D[1, 1] += even + along * y * y
    a = 1.0 + (D[0, 0] * Y[0, 0] + D[0, 1] * Y[1, 0]) / (2 * dt)
    b = (D[0, 0] * Y[0, 1] + D[0, 1] * Y[1, 1]) / (2 * dt)
    c = (D[1, 0] * Y[0, 0] + D[1, 1] * Y[1, 0]) / (2 * dt)
    d = 1.0 + (D[1, 0] * Y[0, 1] + D[1, 1] * Y[1, 1]) / (2 * dt)
    scale = 1.0 / (2 * dt * (a * d - b * c))
    for i in range(2):
        support.yielding[0, i] = scale * (d * D[0, i] - b * D[1, i])
        support.yielding[1, i] = scale * (a * D[1, i] - c * D[0, i])


@inlined_kernel
def push_supports(
    support: Support,
    speed: float,
    dt: float,
    cosine: float,
    sine: float,
    before: FloatArray,
    now: FloatArray,
    after: FloatArray,
) -> bool:
    """Add what f and gravity at step n do to q* without contact, all in z; False where O_d is beyond the film."""
    i, j = support.centre[0], support.centre[1]
    x, y = now[i], now[j]
    if support.film > 0.0 and not x * x + y * y < support.clearance * support.clearance:
        return False
    build_drag(support, cosine, sine, x, y, dt)
    force, weight = support.force, support.columns
    for a in range(support.places.shape[0]):
        after[support.places[a]] += sine * weight[a, 2] + cosine * weight[a, 3]
    # f = (1 + D Y / 2 dt)^-1 [-k_a Q u_n - D (v* + Omega e_z x u_n)]: the bracket's spring counts as if D gave it.
    spring_x, spring_y = turned(cosine, sine, -support.stiffness * x, -support.stiffness * y)
    way_x = after[i] - before[i] - 2 * dt * speed * y
    way_y = after[j] - before[j] + 2 * dt * speed * x
    Y, S = support.compliance, support.yielding
    way_x += Y[0, 0] * spring_x + Y[0, 1] * spring_y
    way_y += Y[1, 0] * spring_x + Y[1, 1] * spring_y
    force[0, 0] = spring_x - S[0, 0] * way_x - S[0, 1] * way_y
    force[0, 1] = spring_y - S[1, 0] * way_x - S[1, 1] * way_y
    for a in range(support.places.shape[0]):
        after[support.places[a]] += force[0, 0] * weight[a, 0] + force[0, 1] * weight[a, 1]
    force[1, 0], force[1, 1] = force[0, 0], force[0, 1]
    return True


@inlined_kernel
def yield_to_contacts(count: int, support: Support, work: ContactWork) -> None:
    """W becomes that of A + E D E^T / 2 dt: less by (B_n^T A^-1 E) (1 + D Y / 2 dt)^-1 D / 2 dt (E^T A^-1 B)."""
    S = support.yielding
    for column in range(count):
        other, x, y = 3 * work.blade[column], 0.0, 0.0
        for b in range(3):
            x += support.tip_rows[other + b, 0] * work.full_tip[column, b]
            y += support.tip_rows[other + b, 1] * work.full_tip[column, b]
        drag_x, drag_y = S[0, 0] * x + S[0, 1] * y, S[1, 0] * x + S[1, 1] * y
        for row in range(count):
            base, less = 3 * work.blade[row], 0.0
            for a in range(3):
                moved = support.tip_columns[base + a, 0] * drag_x + support.tip_columns[base + a, 1] * drag_y
                less += work.normal_tip[row, a] * moved
            work.W[row, column] -= less


@inlined_kernel
def resist_contacts(support: Support, force: FloatArray) -> None:
    """Add to a contact force in z the change of f that its jump of velocity brings."""
    x = dot_rows(support.rows[0], force, force.shape[0] // LANES)
    y = dot_rows(support.rows[1], force, force.shape[0] // LANES)
    S = support.yielding
    for i in range(2):
        change = -S[i, 0] * x - S[i, 1] * y
        force[support.centre[i]] += change
        support.force[1, i] = support.force[0, i] + change


@inlined_kernel
def book_supports(
    support: Support, speed: float, dt: float, cosine: float, sine: float, now: FloatArray, change: FloatArray
) -> float:
    """Book the works of one step, `change` d in z as `now`; gives the sum of their absolute values.

    Uneven springs and dampers, the film, and gravity, each force on d; apart the film's loss, on dt v_abs, <= 0.
    """
    x, y = now[support.centre[0]], now[support.centre[1]]
    dx, dy = change[support.centre[0]], change[support.centre[1]]
    way_x, way_y = dx - dt * speed * y, dy + dt * speed * x
    gravity = 0.0
    for a in range(support.places.shape[0]):
        weight = sine * support.weight[a, 0] + cosine * support.weight[a, 1]
        gravity -= weight * change[support.places[a]]
    k, c = support.stiffness, support.damping / dt
    uneven_x, uneven_y = turned(cosine, sine, -k * x - c * way_x, -k * y - c * way_y)
    film_x, film_y = support.force[1, 0] - uneven_x, support.force[1, 1] - uneven_y
    uneven, film = uneven_x * dx + uneven_y * dy, 0.0
    if support.film > 0.0:
        film = film_x * dx + film_y * dy
        support.works[FILM_LOSS] += film_x * way_x + film_y * way_y
    else:
        uneven = support.force[1, 0] * dx + support.force[1, 1] * dy
    support.works[ANISOTROPY] += uneven
    support.works[FILM] += film
    support.works[GRAVITY] += gravity
    total: float = abs(uneven) + abs(film) + abs(gravity)
    return total
