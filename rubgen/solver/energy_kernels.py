"""The scheme's own energy identity, booked in every step.

E_n+1/2 = v^T M v / 2 + q_n+1^T K_sym q_n / 2,   v = (q_n+1 - q_n) / dt
dE      = f.d - (C v_c).d - (K_skew q_n).d + lam^T B^T d,   d = (q_n+1 - q_n-1) / 2,   v_c = d / dt
"""

from __future__ import annotations

from typing import NamedTuple

from rubgen.arrays import FloatArray
from rubgen.contact.contact_kernels import ContactWork, contact_slip
from rubgen.contact.geometry_kernels import Surface, Tips, casing_rows, tip_position
from rubgen.jit import allocation_free_kernel
from rubgen.solver.step_kernels import Angles, Laws, State, add_columns, previous_gap

UNBALANCE, DAMPING, CIRCULATORY, CONTACT, NORMAL, FRICTION, DRIVE_LIMIT, ABSOLUTE = range(8)


class Book(NamedTuple):
    """Matrices of the energy terms.

    `blisk_damping`, `casing_damping`: columns of the lower triangle of C_sym with half its diagonal, padded like the
    scheme's blocks, so that d^T C d = 2 d^T (triangle d). K_skew = left right^T over all columns but the first,
    (n, rank + 1) padded; the first of `left` is the unbalance force, of `right` zero. `products` is scratch. `M`, `K`
    (n, n) are the symmetric parts; `works` (8,) the sums so far.
    """

    blisk_damping: FloatArray
    casing_damping: FloatArray
    left: FloatArray
    right: FloatArray
    products: FloatArray
    M: FloatArray
    K: FloatArray
    works: FloatArray


@allocation_free_kernel
def add_triangle(columns: FloatArray, x: FloatArray, sum_out: FloatArray) -> None:
    """sum_out += triangle x for a lower triangle, four columns at a time from their common first row."""
    quads = x.shape[0] // 4 * 4
    for j in range(0, quads, 4):
        a, b, c, d = x[j], x[j + 1], x[j + 2], x[j + 3]
        first, second = columns[j, j:], columns[j + 1, j:]
        third, fourth = columns[j + 2, j:], columns[j + 3, j:]
        total = sum_out[j:]
        for i in range(total.shape[0]):
            total[i] += a * first[i] + b * second[i] + c * third[i] + d * fourth[i]
    if quads < x.shape[0]:
        add_columns(columns[quads:], x[quads:], sum_out)


@allocation_free_kernel
def dot(a: FloatArray, b: FloatArray) -> float:
    """a.b over the length of a, in four interleaved sums."""
    s0, s1, s2, s3 = 0.0, 0.0, 0.0, 0.0
    quads = a.shape[0] // 4 * 4
    for i in range(0, quads, 4):
        s0 += a[i] * b[i]
        s1 += a[i + 1] * b[i + 1]
        s2 += a[i + 2] * b[i + 2]
        s3 += a[i + 3] * b[i + 3]
    for i in range(quads, a.shape[0]):
        s0 += a[i] * b[i]
    return (s0 + s1) + (s2 + s3)


@allocation_free_kernel
def dissipated(triangle: FloatArray, d: FloatArray, sum_work: FloatArray) -> float:
    """d^T C_sym d of one block."""
    sum_work[:] = 0.0
    add_triangle(triangle, d, sum_work)
    return 2.0 * dot(d, sum_work)


@allocation_free_kernel
def stored_energy(M: FloatArray, K: FloatArray, before: FloatArray, now: FloatArray, dt: float) -> float:
    """v^T M v / 2 + now^T K_sym before / 2 with v = (now - before) / dt."""
    n = now.shape[0]
    kinetic, elastic = 0.0, 0.0
    for i in range(n):
        momentum, force = 0.0, 0.0
        for j in range(n):
            momentum += M[i, j] * (now[j] - before[j])
            force += K[i, j] * before[j]
        kinetic += (now[i] - before[i]) * momentum
        elastic += now[i] * force
    return 0.5 * kinetic / (dt * dt) + 0.5 * elastic


@allocation_free_kernel
def book_linear(book: Book, state: State, dt: float, casing_start: int) -> None:
    """Works of unbalance, dampers and circulatory stiffness in one step; `state.change` holds d."""
    d, now = state.change, state.now
    left, right = book.products[0], book.products[1]
    book.products[:, :] = 0.0
    add_columns(book.left, d, left)
    add_columns(book.right, now, right)
    unbalance, circulatory = left[0], 0.0
    for r in range(1, left.shape[0]):
        circulatory -= left[r] * right[r]
    damping = -dissipated(book.blisk_damping, d[:casing_start], state.blisk_sum) / dt
    damping -= dissipated(book.casing_damping, d[casing_start:], state.casing_sum) / dt
    book.works[UNBALANCE] += unbalance
    book.works[DAMPING] += damping
    book.works[CIRCULATORY] += circulatory
    book.works[ABSOLUTE] += abs(unbalance) + abs(damping) + abs(circulatory)


@allocation_free_kernel
def book_contact(
    m: int,
    surface: Surface,
    tips: Tips,
    laws: Laws,
    angles: Angles,
    step: int,
    opening: FloatArray,
    state: State,
    work: ContactWork,
    book: Book,
) -> tuple[float, float]:
    """Works at contact m in one step; gives its normal loss and friction loss, J.

    Normal loss lam (g_n+1 - g_n-1) / 2 with the gaps that the scheme held at those steps (the linearised ones where
    the blade was near, else the geometric one). Friction loss lam mu tau.v_rel dt, tau the direction that the step used
    and v_rel its central relative velocity; it is -mu lam |v_rel| dt but for the change of v_rel's direction by the
    contact itself. The drive's limit is -Omega dt e_z.(P x F).
    """
    k, lam = work.blade[m], work.lam[m]
    start, last = state.now.shape[0] - work.rows.shape[1], angles.cosine.shape[0] - 1
    back = step - 1 if step > 0 else last - 1
    done = 0.0
    for a in range(3):
        done += work.full_tip[m, a] * state.change[3 * k + a]
    for j in range(work.rows.shape[1]):
        done += work.full_casing[m, j] * state.change[start + j]
    held = previous_gap(surface, tips, k, state, opening[step], angles.cosine[back], angles.sine[back], work)
    normal = 0.5 * lam * (work.held[2, k] - held)
    casing_rows(surface, work.psi[k], work.rows)
    _, _, cosine, sine = tip_position(tips, k, state.after, angles.cosine[step + 1], angles.sine[step + 1])
    along, axial = contact_slip(tips, m, state.change, state.after, laws.speed * laws.dt, cosine, sine, work)
    friction = laws.friction * lam * (work.slip[m, 0] * along + work.slip[m, 1] * axial)
    radial = tips.radius + tips.static[k, 0] + state.after[3 * k]
    tangential = tips.static[k, 1] + state.after[3 * k + 1]
    torque = lam * (radial * work.full_tip[m, 1] - tangential * work.full_tip[m, 0])
    book.works[CONTACT] += lam * done
    book.works[NORMAL] += normal
    book.works[FRICTION] += friction
    book.works[DRIVE_LIMIT] -= laws.speed * laws.dt * torque
    book.works[ABSOLUTE] += abs(lam * done)
    return normal, friction
