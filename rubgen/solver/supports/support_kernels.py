"""Forces that no constant matrix contains: uneven supports, laws of the support, gravity, loads of faults.

On the disk centre O_d, in the turning frame and at the time of step n,

    f = p(theta_n) - k_a Q(theta_n) u_n + s(u_n) - D v_abs,   D = c_a Q(theta_n) + D(u_n)
    v_abs = (u_n+1 - u_n-1) / (2 dt) + Omega e_z x u_n

with p the loads of faults, k_a and c_a the anisotropy of springs and dampers, Q(theta) their matrix, s(u) and D(u) the
sums over the laws (`reduction.model.TurningForces`). f depends linearly on the velocity and is taken implicitly, like
the scheme's own dampers: u_n+1 = u* + Y f with Y = E^T A^-1 E leaves two equations. E selects x and y of O_d. z are the
coordinates in the order of the blocks (`linalg.blocks`). In the contact problem A + E D E^T / (2 dt) replaces A. The
work of D is therefore never positive where D is positive semidefinite, whatever the contact does in the same step.
"""

from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.contact.contact_kernels import ContactWork
from rubgen.jit import allocation_free_kernel, inlined_kernel, switch
from rubgen.linalg.lanes_kernels import dot_rows
from rubgen.linalg.vector_kernels import LANES
from rubgen.machine.support_laws.disk_support import LAWS as ALL_LAWS

ANISOTROPY, LAWS, GRAVITY, LOADS, LAWS_LOSS = range(5)
SUPPORT_WORKS = 5
law_terms = switch([law.terms for law in ALL_LAWS])
"""`SupportLaw.terms` of the law with the number that stands first."""


class Support(NamedTuple):
    """Constants of the forces on O_d, and their products with A^-1."""

    active: bool
    """False where a system has none of these forces; then nothing else is read."""
    yields: bool
    """Whether f depends on the motion; loads and gravity alone do not."""
    stiffness: float
    """k_a, N/m."""
    damping: float
    """c_a, N s/m."""
    laws: FloatArray
    """A row for each law that acts (any, any): its number in the registry, and the constants that its
    `SupportLaw.terms` takes."""
    limit: float
    """The eccentricity at which one of them ends, m."""
    centre: IntArray
    """Indices in z of O_d x, y (2,)."""
    places: IntArray
    """Indices in z (m,) of the coordinates that a force on O_d or the weight can move."""
    columns: FloatArray
    """A^-1 at `places` (m, 4) times unit forces on O_d x, y, and times minus the weight's sin and cos part."""
    weight: FloatArray
    """The weight's sin and cos part at `places` (m, 2), N."""
    compliance: FloatArray
    """Y = E^T A^-1 E (2, 2), m/N."""
    rows: FloatArray
    """E^T A^-1 (2, size of z)."""
    tip_columns: FloatArray
    """A^-1 E at the tip coordinates (3 blades, 2)."""
    tip_rows: FloatArray
    """The transpose of E^T A^-1 there (3 blades, 2)."""
    loads: FloatArray
    """Real and imaginary part of p_x and p_y (orders, 4), N, at step 0 of what is run; row m turns with m theta."""
    slopes: FloatArray
    """Their change in a step (orders, 4), N."""
    growing: FloatArray
    """Loads that grow (any, orders, 4), N, when they have grown. Kernels do not read them."""


class SupportState(NamedTuple):
    """The forces of a step, and their works so far."""

    drag: FloatArray
    """D (2, 2), N s/m."""
    yielding: FloatArray
    """(1 + D Y / 2 dt)^-1 D / 2 dt (2, 2)."""
    force: FloatArray
    """f without contact and with it, and p (3, 2), N."""
    works: FloatArray
    """Works so far (5,), J, at ANISOTROPY, LAWS, GRAVITY, LOADS, LAWS_LOSS."""


@inlined_kernel
def turned(cosine: float, sine: float, x: float, y: float) -> tuple[float, float]:
    """Return Q(theta) (x, y): the vector (x, y) times the matrix of uneven supports.

    `cosine` and `sine` are of theta.
    """
    double_cosine, double_sine = cosine * cosine - sine * sine, 2.0 * cosine * sine
    return double_cosine * x - double_sine * y, -double_sine * x - double_cosine * y


@inlined_kernel
def load_at(support: Support, step: int, cosine: float, sine: float, out: FloatArray) -> None:
    """Write the loads of faults p = Re sum_m p_m e^(i m theta) at a step into `out` (2,), N, by Horner's rule.

    `cosine` and `sine` are of theta at the step.
    """
    x, y, x_imaginary, y_imaginary = 0.0, 0.0, 0.0, 0.0
    for m in range(support.loads.shape[0] - 1, -1, -1):
        row, slope = support.loads[m], support.slopes[m]
        x, x_imaginary = (
            x * cosine - x_imaginary * sine + row[0] + step * slope[0],
            x * sine + x_imaginary * cosine + row[1] + step * slope[1],
        )
        y, y_imaginary = (
            y * cosine - y_imaginary * sine + row[2] + step * slope[2],
            y * sine + y_imaginary * cosine + row[3] + step * slope[3],
        )
    out[0], out[1] = x, y


@allocation_free_kernel
def add_laws(laws: FloatArray, cosine: float, sine: float, x: float, y: float, D: FloatArray) -> tuple[float, float]:
    """Add the damping of all laws at u = (x, y), m, to D (2, 2), N s/m. Return the force of their springs, N.

    `laws` has a row for each law: its number in the registry and its constants. `cosine` and `sine` are of theta. It is
    a call, not inlined: a machine without laws then does not step slower.
    """
    spring_x, spring_y = 0.0, 0.0
    for law in range(laws.shape[0]):
        s_x, s_y, xx, xy, yx, yy = law_terms(int(laws[law, 0]), laws[law, 1:], cosine, sine, x, y)
        spring_x += s_x
        spring_y += s_y
        D[0, 0] += xx
        D[0, 1] += xy
        D[1, 0] += yx
        D[1, 1] += yy
    return spring_x, spring_y


@inlined_kernel
def build_drag(
    support: Support, cosine: float, sine: float, x: float, y: float, dt: float, state: SupportState
) -> tuple[float, float]:
    """Write the damping D at u = (x, y) into `state.drag`, and `state.yielding`. Return the laws' spring force s(u), N.

    D = c_a Q(theta) + D(u) of the laws; `yielding` is (1 + D Y / 2 dt)^-1 D / 2 dt. `cosine` and `sine` are of theta. x
    and y are in the turning frame, m.
    """
    D, Y = state.drag, support.compliance
    for i in range(2):
        D[0, i], D[1, i] = turned(cosine, sine, 1.0 - i, float(i))
        D[0, i] *= support.damping
        D[1, i] *= support.damping
    spring_x, spring_y = add_laws(support.laws, cosine, sine, x, y, D)
    a = 1.0 + (D[0, 0] * Y[0, 0] + D[0, 1] * Y[1, 0]) / (2 * dt)
    b = (D[0, 0] * Y[0, 1] + D[0, 1] * Y[1, 1]) / (2 * dt)
    c = (D[1, 0] * Y[0, 0] + D[1, 1] * Y[1, 0]) / (2 * dt)
    d = 1.0 + (D[1, 0] * Y[0, 1] + D[1, 1] * Y[1, 1]) / (2 * dt)
    scale = 1.0 / (2 * dt * (a * d - b * c))
    for i in range(2):
        state.yielding[0, i] = scale * (d * D[0, i] - b * D[1, i])
        state.yielding[1, i] = scale * (a * D[1, i] - c * D[0, i])
    return spring_x, spring_y


@inlined_kernel
def push_supports(
    support: Support,
    speed: float,
    dt: float,
    step: int,
    cosine: float,
    sine: float,
    before: FloatArray,
    now: FloatArray,
    after: FloatArray,
    state: SupportState,
) -> bool:
    """Add the effect of the support force f and of gravity at step n to `after`. Return False beyond a law's limit.

    The limit is compared with the place of O_d at step n, before anything is changed.

    - speed: Omega, rad/s.
    - step: number of step n in the turn or part of a turn.
    - cosine, sine: cosine and sine of theta at step n.
    - before, now: z at steps n - 1 and n.
    - after: z at step n + 1, without f, gravity and contact; changed.
    - state: the forces of the step; written.
    """
    i, j = support.centre[0], support.centre[1]
    x, y = now[i], now[j]
    if not x * x + y * y < support.limit * support.limit:
        return False
    force, weight = state.force, support.columns
    load_at(support, step, cosine, sine, force[2])
    if not support.yields:
        for i in range(2):
            force[0, i] = force[1, i] = force[2, i]
        for a in range(support.places.shape[0]):
            after[support.places[a]] += (
                sine * weight[a, 2] + cosine * weight[a, 3] + force[2, 0] * weight[a, 0] + force[2, 1] * weight[a, 1]
            )
        return True
    laws_x, laws_y = build_drag(support, cosine, sine, x, y, dt, state)
    for a in range(support.places.shape[0]):
        after[support.places[a]] += sine * weight[a, 2] + cosine * weight[a, 3]
    # f = (1 + D Y / 2 dt)^-1 [p + s - k_a Q u_n - D (v* + Omega e_z x u_n)]: the springs are added to the bracket.
    spring_x, spring_y = turned(cosine, sine, -support.stiffness * x, -support.stiffness * y)
    spring_x += laws_x
    spring_y += laws_y
    if support.loads.shape[0] > 0:
        spring_x += force[2, 0]
        spring_y += force[2, 1]
    way_x = after[i] - before[i] - 2 * dt * speed * y
    way_y = after[j] - before[j] + 2 * dt * speed * x
    Y, S = support.compliance, state.yielding
    way_x += Y[0, 0] * spring_x + Y[0, 1] * spring_y
    way_y += Y[1, 0] * spring_x + Y[1, 1] * spring_y
    force[0, 0] = spring_x - S[0, 0] * way_x - S[0, 1] * way_y
    force[0, 1] = spring_y - S[1, 0] * way_x - S[1, 1] * way_y
    for a in range(support.places.shape[0]):
        after[support.places[a]] += force[0, 0] * weight[a, 0] + force[0, 1] * weight[a, 1]
    force[1, 0], force[1, 1] = force[0, 0], force[0, 1]
    return True


@inlined_kernel
def yield_to_contacts(count: int, support: Support, state: SupportState, work: ContactWork) -> None:
    """Correct the compliance matrix `work.W` of `count` contacts for the damping D of the support.

    W = B_n^T A^-1 B is changed as if A were A + E D E^T / 2 dt, where E selects x and y of O_d: subtracted is (B_n^T
    A^-1 E) S (E^T A^-1 B), with S = (1 + D Y / 2 dt)^-1 D / 2 dt = `state.yielding`.
    """
    S = state.yielding
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
def resist_contacts(support: Support, state: SupportState, force: FloatArray) -> None:
    """Add to a contact `force` in z the change of the support force f that the contact causes. Changes `state.force`.

    The contact changes the velocity of O_d, and thereby the force of the dampers in f.
    """
    x = dot_rows(support.rows[0], force, force.shape[0] // LANES)
    y = dot_rows(support.rows[1], force, force.shape[0] // LANES)
    S = state.yielding
    for i in range(2):
        change = -S[i, 0] * x - S[i, 1] * y
        force[support.centre[i]] += change
        state.force[1, i] = state.force[0, i] + change


@inlined_kernel
def add_support_works(
    support: Support,
    speed: float,
    dt: float,
    cosine: float,
    sine: float,
    now: FloatArray,
    change: FloatArray,
    state: SupportState,
) -> float:
    """Add the works of one step to `state.works`, J. Return the sum of their absolute values, J.

    Works of uneven springs and dampers, of the laws, of gravity, and of the loads of faults are each force times d.
    LAWS_LOSS is the force of the laws times dt v_abs; it is not in the sum.

    - speed: Omega, rad/s.
    - cosine, sine: cosine and sine of theta at step n.
    - now, change: z at step n, and d = (z_n+1 - z_n-1) / 2.
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
    f_x, f_y, loads = state.force[1, 0], state.force[1, 1], 0.0
    if support.loads.shape[0] > 0:
        loads = state.force[2, 0] * dx + state.force[2, 1] * dy
        f_x -= state.force[2, 0]
        f_y -= state.force[2, 1]
    laws_x, laws_y = f_x - uneven_x, f_y - uneven_y
    uneven, laws = uneven_x * dx + uneven_y * dy, 0.0
    if support.laws.shape[0] > 0:
        laws = laws_x * dx + laws_y * dy
        state.works[LAWS_LOSS] += laws_x * way_x + laws_y * way_y
    else:
        uneven = f_x * dx + f_y * dy
    state.works[ANISOTROPY] += uneven
    state.works[LAWS] += laws
    state.works[GRAVITY] += gravity
    state.works[LOADS] += loads
    total: float = abs(uneven) + abs(laws) + abs(gravity) + abs(loads)
    return total
