"""The scheme's own energy identity, whose works are summed in every step. z is q in the order of the blocks.

E_n+1/2 = v^T M v / 2 + q_n+1^T K_sym q_n / 2,   v = (q_n+1 - q_n) / dt
dE      = f.d - (C v_c).d - (K_skew q_n).d + lam^T B^T d,   d = (q_n+1 - q_n-1) / 2,   v_c = d / dt
"""

from rubgen.arrays import FloatArray
from rubgen.contact.contact_kernels import contact_slip
from rubgen.contact.geometry_kernels import casing_rows, tip_position
from rubgen.jit import allocation_free_kernel, inlined_kernel
from rubgen.linalg.block_kernels import quadratic, quadratic_each
from rubgen.linalg.lanes_kernels import TOGETHER, dot_pairs
from rubgen.solver.scheme.contact_step_kernels import previous_gap
from rubgen.solver.scheme.model_kernels import EnergyTerms, Model
from rubgen.solver.scheme.state_kernels import Coordinates, State, Waiting

UNBALANCE, DAMPING, CIRCULATORY, CONTACT, NORMAL, FRICTION, ABSOLUTE, SPEED_CHANGE = range(8)
WORKS = 8


@allocation_free_kernel
def stored_energy(terms: EnergyTerms, before: FloatArray, now: FloatArray, difference: FloatArray, dt: float) -> float:
    """Return the stored energy v^T M v / 2 + now^T K_sym before / 2, J, with v = difference / dt.

    `before` and `now` are z at two successive steps, `difference` is now - before, `dt` in s.
    """
    kinetic = quadratic(terms.M, difference, difference) / (dt * dt)
    return 0.5 * (kinetic + quadratic(terms.K, now, before))


@inlined_kernel
def add_works(terms: EnergyTerms, change: FloatArray, damping: float, circulatory: float, works: FloatArray) -> None:
    """Add the works of unbalance, dampers and circulatory stiffness in one step to `works` (8,), J.

    `damping` and `circulatory` are the last two works, J. `change` is d = (q_n+1 - q_n-1) / 2 in z. The three
    absolute values are added to `works[ABSOLUTE]`.
    """
    unbalance = 0.0
    for i in range(terms.force.shape[0]):
        unbalance += terms.force[i] * change[terms.force_places[i]]
    works[UNBALANCE] += unbalance
    works[DAMPING] += damping
    works[CIRCULATORY] += circulatory
    works[ABSOLUTE] += abs(unbalance) + abs(damping) + abs(circulatory)


@inlined_kernel
def add_linear_works(terms: EnergyTerms, now: FloatArray, change: FloatArray, dt: float, works: FloatArray) -> None:
    """Compute the works of unbalance, dampers and circulatory stiffness in one step, and add them to `works` (8,), J.

    `now` is z at step n, `change` is d = (q_n+1 - q_n-1) / 2 in z, `dt` in s. See `add_works`.
    """
    damping = -2.0 * quadratic(terms.damping, change, change) / dt
    if terms.circulatory_pairs.shape[0] > 0:
        circulatory = -dot_pairs(terms.circulatory_pairs, change, now)
    else:
        circulatory = -quadratic(terms.circulatory, change, now)
    add_works(terms, change, damping, circulatory, works)


@allocation_free_kernel
def add_waiting_works(terms: EnergyTerms, count: int, dt: float, waiting: Waiting, works: FloatArray) -> None:
    """Add to `works` what `add_linear_works` adds in each of the first `count` steps that wait in `waiting`.

    `waiting.damping` and `waiting.circulatory` are overwritten.
    """
    if count == 0:
        return
    quadratic_each(terms.damping, waiting.change, waiting.change, waiting.damping)
    if terms.circulatory_pairs.shape[0] > 0:
        for i in range(count):
            waiting.circulatory[i] = dot_pairs(terms.circulatory_pairs, waiting.change[i], waiting.now[i])
    else:
        quadratic_each(terms.circulatory, waiting.change, waiting.now, waiting.circulatory)
    for i in range(count):
        add_works(terms, waiting.change[i], -2.0 * waiting.damping[i] / dt, -waiting.circulatory[i], works)


@inlined_kernel
def book_linear_works(
    terms: EnergyTerms, now: FloatArray, change: FloatArray, dt: float, count: int, waiting: Waiting, works: FloatArray
) -> int:
    """Add the works of `add_linear_works` to `works`, at once or, with large matrices, when TOGETHER steps wait.

    Return the number of steps that wait in `waiting`; `count` is their number before this step. The other parameters
    are as in `add_linear_works`.
    """
    if not terms.waits:
        add_linear_works(terms, now, change, dt, works)
        return 0
    for i in range(change.shape[0]):
        waiting.change[count, i] = change[i]
        waiting.now[count, i] = now[i]
    if count + 1 < TOGETHER:
        return count + 1
    add_waiting_works(terms, TOGETHER, dt, waiting, works)
    return 0


@inlined_kernel
def add_contact_works(
    m: int, model: Model, step: int, opening: FloatArray, coordinates: Coordinates, state: State
) -> tuple[float, float, float]:
    """Add the works at contact m in one step. Return its normal and friction loss, J, and torque on the blisk, N m.

    A loss is negative where energy is lost. The torque is about Z. The normal loss is lam (g_n+1 - g_n-1) / 2. The gaps
    are the scheme's: linearised where the blade was near, else geometric. The friction loss is lam mu tau.v_rel dt,
    with tau the direction of friction in the step and v_rel the central relative velocity. It is -mu lam |v_rel| dt,
    except that the contact changes the direction of v_rel. The works go into `state.works`: CONTACT, NORMAL, FRICTION
    and ABSOLUTE.

    - m: number of the contact in `state.contact`, not of the blade.
    - step: number of the step n in `model.angles`.
    - opening (steps + 2,): added to the radius of the surface at steps -1, 0, ..., m.
    - coordinates: of the contact's blade the tip coordinates must be valid. `change` is d = (q_n+1 - q_n-1) / 2.
    """
    surface, tips, laws, angles = model.surface, model.tips, model.laws, model.angles
    work, works = state.contact, state.works
    k, lam = work.blade[m], work.lam[m]
    start = coordinates.now.shape[0] - work.rows.shape[1]
    back = step - 1 if step > 0 else angles.cosine.shape[0] - 1
    done = 0.0
    for a in range(3):
        done += work.full_tip[m, a] * coordinates.change[3 * k + a]
    for j in range(work.rows.shape[1]):
        done += work.full_casing[m, j] * coordinates.change[start + j]
    gap = previous_gap(
        surface, tips, state.wear.depth, k, coordinates, opening[step], angles.cosine[back], angles.sine[back], work
    )
    normal = 0.5 * lam * (work.step_gaps[2, k] - gap)
    casing_rows(surface, work.psi[k], work.rows)
    _, _, cosine, sine = tip_position(tips, k, coordinates.after, angles.cosine[step + 1], angles.sine[step + 1])
    along, axial = contact_slip(
        tips, m, coordinates.change, coordinates.after, laws.speed * laws.dt, cosine, sine, work
    )
    friction = laws.friction * lam * (work.slip[m, 0] * along + work.slip[m, 1] * axial)
    radial = tips.radius + tips.static[0, k] + coordinates.after[3 * k]
    tangential = tips.static[1, k] + coordinates.after[3 * k + 1]
    torque = lam * (radial * work.full_tip[m, 1] - tangential * work.full_tip[m, 0])
    works[CONTACT] += lam * done
    works[NORMAL] += normal
    works[FRICTION] += friction
    works[ABSOLUTE] += abs(lam * done)
    return normal, friction, torque
