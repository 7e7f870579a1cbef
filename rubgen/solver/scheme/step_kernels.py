"""One step of the central difference scheme with Lagrange multipliers, in forward increments.

    A     = M / dt^2 + C / (2 dt)
    q*    = A^-1 [f - K q_n + 2 M / dt^2 q_n - (M / dt^2 - C / (2 dt)) q_n-1]
    q_n+1 = q* + A^-1 B lam,   0 <= lam  _|_  g(q*) + e g_n-1 + W lam >= 0

(Carpenter, Taylor, Katona 1991; restitution e of Paoli and Schatzman.) The matrices are in blocks (`block_kernels`).
Contact is solved in physical coordinates (`contact_step_kernels`).
"""

from rubgen.arrays import FloatArray
from rubgen.contact.clearance_kernels import casing_displacement_bound, largest_nodal_displacement
from rubgen.contact.contact_kernels import ContactWork
from rubgen.contact.geometry_kernels import Surface
from rubgen.jit import allocation_free_kernel, inlined_kernel
from rubgen.linalg.harmonic_kernels import recover_all
from rubgen.linalg.lanes_kernels import dot_rows
from rubgen.linalg.vector_kernels import LANES
from rubgen.solver.scheme.contact_step_kernels import contact_step
from rubgen.solver.scheme.free_step_kernels import free_step
from rubgen.solver.scheme.model_kernels import Laws, Model
from rubgen.solver.scheme.motion_kernels import Motion, recover
from rubgen.solver.scheme.state_kernels import DIVERGED, FILM_CLOSED, Scratch, State
from rubgen.solver.supports.support_kernels import push_supports


@allocation_free_kernel
def has_diverged(surface: Surface, laws: Laws, q: FloatArray, casing_start: int, n_blades: int) -> bool:
    """Return whether a casing node, or a coordinate of a blade tip, is beyond its limit or is NaN.

    `q` (n,) begins with the tips, three a blade, in m; the casing's begin at `casing_start`. `laws` has the limits.
    """
    for k in range(3 * n_blades):
        if not abs(q[k]) <= laws.tip_limit:
            return True
    q_casing = q[casing_start:]
    if casing_displacement_bound(surface, q_casing) <= laws.casing_limit:
        return False
    return not largest_nodal_displacement(surface, q_casing) <= laws.casing_limit


@inlined_kernel
def leaves_range(model: Model, motion: Motion, casing_bound: float, scratch: Scratch) -> bool:
    """Return whether a motion has diverged, as `has_diverged` does. Bounds are checked first, which are faster.

    No tip coordinate is larger than the norm of z. `casing_bound` is a bound of the casing's displacement, m. The tip
    coordinates in `motion.q` may be overwritten by their values.
    """
    norm = dot_rows(motion.z, motion.z, motion.z.shape[0] // LANES)
    if norm <= model.laws.tip_limit**2 and casing_bound <= model.laws.casing_limit:
        return False
    recover_all(model.harmonics, motion.z, scratch.share, scratch.tips, motion.q)
    start = motion.q.shape[0] - model.surface.mode_displacement.shape[0]
    return has_diverged(model.surface, model.laws, motion.q, start, model.harmonics.basis.shape[0])


@inlined_kernel
def advance(
    model: Model,
    step: int,
    opening: FloatArray,
    before: Motion,
    now: Motion,
    after: Motion,
    state: State,
) -> tuple[int, int]:
    """Make one step: q_n+1 into `after`. Return OK or the code of a failure, and the number of contacts solved.

    - step: number of the step n in `model.angles`.
    - opening (steps + 2,): added to the radius of the surface at steps -1, 0, ..., m.
    - before, now: motion at steps n - 1 and n.
    - after: written; where the step fails, as far as it came. Its tip coordinates in q are not valid.
    - state: gaps, contacts, supports and scratch; changed.
    """
    free_step(model.scheme, before.z, now.z, after.z)
    if model.support.active and not push_supports(
        model.support, model.laws.speed, model.laws.dt, step,
        model.angles.cosine[step], model.angles.sine[step], before.z, now.z, after.z, state.support,
    ):  # fmt: skip
        return FILM_CLOSED, 0
    recover(model.harmonics, after, state.scratch.share)
    casing_bound = casing_displacement_bound(model.surface, after.q[after.q.shape[0] - state.contact.rows.shape[1] :])
    if leaves_range(model, after, casing_bound, state.scratch):
        return DIVERGED, 0
    return contact_step(model, step, opening, before, now, after, casing_bound, state)


@inlined_kernel
def shift_gaps(work: ContactWork) -> None:
    """Move the gaps at steps n and n + 1 in `work.step_gaps` to n - 1 and n, for the next step."""
    for k in range(work.step_gaps.shape[1]):
        work.step_gaps[0, k] = work.step_gaps[1, k]
        work.step_gaps[1, k] = work.step_gaps[2, k]
