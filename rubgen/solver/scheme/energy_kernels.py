"""The scheme's own energy identity, booked in every step.

E_n+1/2 = v^T M v / 2 + q_n+1^T K_sym q_n / 2,   v = (q_n+1 - q_n) / dt
dE      = f.d - (C v_c).d - (K_skew q_n).d + lam^T B^T d,   d = (q_n+1 - q_n-1) / 2,   v_c = d / dt
"""

from __future__ import annotations

from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.contact.contact_kernels import ContactWork, contact_slip
from rubgen.contact.geometry_kernels import Surface, Tips, casing_rows, tip_position
from rubgen.jit import allocation_free_kernel, inlined_kernel
from rubgen.linalg.block_kernels import Product, quadratic
from rubgen.solver.scheme.model_kernels import Angles, Laws, State
from rubgen.solver.scheme.step_kernels import previous_gap

UNBALANCE, DAMPING, CIRCULATORY, CONTACT, NORMAL, FRICTION, DRIVE_LIMIT, ABSOLUTE, SPEED_CHANGE = range(9)
WORKS = 9


class Book(NamedTuple):
    """Matrices of the energy terms in blocks, and the works.

    `damping` is the lower triangle of C_sym with half its diagonal, so that d^T C d = 2 d^T (triangle d); `circulatory`
    K_skew; `M`, `K` the symmetric parts. `force` are the numbers of the unbalance force that are not zero, at
    `force_places` of z. `works` (9,) the sums so far.
    """

    damping: Product
    circulatory: Product
    M: Product
    K: Product
    force: FloatArray
    force_places: IntArray
    works: FloatArray


@allocation_free_kernel
def stored_energy(book: Book, before: FloatArray, now: FloatArray, difference: FloatArray, dt: float) -> float:
    """v^T M v / 2 + now^T K_sym before / 2, all in z; `difference` is dt v = now - before."""
    kinetic = quadratic(book.M, difference, difference) / (dt * dt)
    return 0.5 * (kinetic + quadratic(book.K, now, before))


@inlined_kernel
def book_linear(book: Book, now: FloatArray, change: FloatArray, dt: float) -> None:
    """Works of unbalance, dampers and circulatory stiffness in one step; `change` is d, in z as `now`."""
    unbalance = 0.0
    for i in range(book.force.shape[0]):
        unbalance += book.force[i] * change[book.force_places[i]]
    damping = -2.0 * quadratic(book.damping, change, change) / dt
    circulatory = -quadratic(book.circulatory, change, now)
    book.works[UNBALANCE] += unbalance
    book.works[DAMPING] += damping
    book.works[CIRCULATORY] += circulatory
    book.works[ABSOLUTE] += abs(unbalance) + abs(damping) + abs(circulatory)


@inlined_kernel
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
) -> tuple[float, float, float]:
    """Works at contact m in one step; gives its normal loss and friction loss, J, and its torque on the blisk, N m.

    Normal loss lam (g_n+1 - g_n-1) / 2 with the gaps that the scheme held at those steps (the linearised ones where
    the blade was near, else the geometric one). Friction loss lam mu tau.v_rel dt, tau the direction that the step used
    and v_rel its central relative velocity; it is -mu lam |v_rel| dt but for the change of v_rel's direction by the
    contact itself. The drive's limit is -Omega dt e_z.(P x F).
    """
    k, lam = work.blade[m], work.lam[m]
    start = state.now.shape[0] - work.rows.shape[1]
    back = step - 1 if step > 0 else angles.cosine.shape[0] - 1
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
    radial = tips.radius + tips.static[0, k] + state.after[3 * k]
    tangential = tips.static[1, k] + state.after[3 * k + 1]
    torque = lam * (radial * work.full_tip[m, 1] - tangential * work.full_tip[m, 0])
    book.works[CONTACT] += lam * done
    book.works[NORMAL] += normal
    book.works[FRICTION] += friction
    book.works[DRIVE_LIMIT] -= laws.speed * laws.dt * torque
    book.works[ABSOLUTE] += abs(lam * done)
    return normal, friction, torque
