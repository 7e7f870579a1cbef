"""The contact of one step: from q*, the motion without contact, to q_n+1, in physical coordinates.

    q_n+1 = q* + A^-1 B lam,   0 <= lam  _|_  g(q*) + e g_n-1 + W lam >= 0

(Carpenter, Taylor, Katona 1991; restitution e of Paoli and Schatzman.)
"""

import math

from rubgen.arrays import FloatArray
from rubgen.contact.clearance_kernels import (
    Deformation,
    clearance_bounds,
    deformation_bounds,
    larger_margin,
    radial_margin,
    tighten,
)
from rubgen.contact.contact_kernels import (
    ContactWork,
    build_casing_response,
    build_compliance,
    build_rows,
    find_near,
    gap_at,
    largest_approach,
)
from rubgen.contact.geometry_kernels import Surface, Tips
from rubgen.contact.lcp_kernels import SOLVED, solve_normal
from rubgen.jit import allocation_free_kernel, inlined_kernel
from rubgen.linalg.block_kernels import Product, multiply
from rubgen.linalg.harmonic_kernels import spread_tip_force
from rubgen.solver.scheme.model_kernels import Laws, Model
from rubgen.solver.scheme.motion_kernels import Motion, copy_motion, recover, recover_blade
from rubgen.solver.scheme.state_kernels import CONTACT_UNSOLVED, OK, Coordinates, State
from rubgen.solver.supports.support_kernels import resist_contacts, yield_to_contacts

MARGIN_TRIES = 6


@allocation_free_kernel
def previous_gap(
    surface: Surface,
    tips: Tips,
    worn: FloatArray,
    blade: int,
    coordinates: Coordinates,
    opening: float,
    cosine: float,
    sine: float,
    work: ContactWork,
) -> float:
    """Return the gap of a blade at step n - 1, m: the scheme's gap if it is known, else the gap from the geometry.

    The result is kept in `work.step_gaps[0]`. The blade's tip coordinates in `coordinates.before` must be valid.

    - worn (bins,): coefficients of the worn depth, m; (0,) without a liner.
    - opening: added to the radius of the surface at step n - 1, m.
    - cosine, sine: cosine and sine of the blisk's angle at step n - 1.
    """
    gap: float = work.step_gaps[0, blade]
    if math.isnan(gap):
        start = coordinates.now.shape[0] - work.rows.shape[1]
        gap = gap_at(surface, tips, worn, blade, coordinates.before, start, opening, cosine, sine, work.ends)
        work.step_gaps[0, blade] = gap
    return gap


@inlined_kernel
def starting_margin(laws: Laws, step_gaps: FloatArray) -> float:
    """Return the smallest margin within which blades are solved together, m: `laws.margin`, more with restitution.

    Restitution adds its coefficient times the deepest penetration in `step_gaps` at step n - 1.
    """
    deepest = 0.0
    if laws.restitution > 0.0:
        for k in range(step_gaps.shape[1]):
            if step_gaps[0, k] < deepest:
                deepest = step_gaps[0, k]
    return laws.margin - laws.restitution * deepest


@inlined_kernel
def recover_contacts(count: int, model: Model, motion: Motion, work: ContactWork) -> None:
    """Write the tip coordinates of the blades of `count` contacts into `motion.q`, from its z and `tips`."""
    for m in range(count):
        recover_blade(model.harmonics, motion, work.blade[m])


@inlined_kernel
def change_contacts(
    count: int, before: Motion, after: Motion, scale: float, work: ContactWork, change_out: FloatArray
) -> None:
    """Write scale (q_after - q_before) into `change_out` (n,), for the tips of `count` contacts and the casing alone.

    The tip coordinates in both q must be valid (`recover_contacts`). No other element is written.
    """
    for m in range(count):
        k = work.blade[m]
        for i in range(3 * k, 3 * k + 3):
            change_out[i] = scale * (after.q[i] - before.q[i])
    for i in range(change_out.shape[0] - work.rows.shape[1], change_out.shape[0]):
        change_out[i] = scale * (after.q[i] - before.q[i])


@inlined_kernel
def solve_contacts(
    count: int, model: Model, step: int, opening: FloatArray, coordinates: Coordinates, state: State
) -> int:
    """Solve for the normal forces of all `count` near blades at q* (`coordinates.after`). Return SOLVED or UNSOLVED.

    The forces go into `state.contact.lam`. `state.contact` must contain the blades of `find_near`.

    - step: number of the step n in `model.angles`.
    - opening (steps + 2,): added to the radius of the surface at steps -1, 0, ..., m.
    - coordinates: of the contacts' blades the tip coordinates must be valid. `change` is (q* - q_n-1) / (2 dt).
    """
    surface, tips, laws, angles = model.surface, model.tips, model.laws, model.angles
    work, back = state.contact, step - 1 if step > 0 else angles.cosine.shape[0] - 1
    for m in range(count):
        k = work.blade[m]
        build_rows(
            surface, tips, m, coordinates.after, coordinates.change, laws.speed, laws.friction,
            angles.cosine[step + 1], angles.sine[step + 1], work,
        )  # fmt: skip
        build_casing_response(m, model.casing_compliance, work)
        work.b[m] = work.gap[k]
        if laws.regards_rate:
            before = previous_gap(
                surface, tips, state.wear.depth, k, coordinates, opening[step], angles.cosine[back],
                angles.sine[back], work,
            )  # fmt: skip
            work.tableau[0, m] = before
            work.b[m] += laws.restitution * before
    build_compliance(count, model.tip_compliance, work)
    if model.support.active:
        yield_to_contacts(count, model.support, state.support, work)
    return solve_normal(laws.normal, work.W, work.b, count, work.lam, work.square, work.tableau, work.basis)


@inlined_kernel
def apply_contacts(count: int, model: Model, after: Motion, state: State) -> None:
    """Move the motion `after` from q* to q_n+1: add A^-1 (B lam) of the forces of `count` contacts to its z.

    z are all coordinates, in the order of the blocks. `tips` and the coordinates behind the tips in `after.q` follow.
    The tip coordinates in `after.q` stay those of q*, without contact, until `recover_contacts`. lam and B are in
    `state.contact`, as `solve_contacts` leaves them. With an active support the force contains the support's reaction
    (`resist_contacts`). `state.scratch.z_force` is overwritten.
    """
    work, force, harmonics = state.contact, state.scratch.z_force, model.harmonics
    start = harmonics.rest.shape[0] - work.rows.shape[1]
    force[:] = 0.0
    for m in range(count):
        lam = work.lam[m]
        if lam > 0.0:
            spread_tip_force(harmonics, work.blade[m], work.full_tip[m], lam, force)
            for j in range(work.rows.shape[1]):
                force[harmonics.rest[start + j]] += lam * work.full_casing[m, j]
    if model.support.active:
        resist_contacts(model.support, state.support, force)
    multiply(Product(model.scheme.lines, model.scheme.inverse), force, after.z)
    recover(harmonics, after, state.scratch.share)


@inlined_kernel
def bound_clearances(
    model: Model,
    inside: int,
    opening: float,
    after: Motion,
    deformation: Deformation,
    enough: float,
    work: ContactWork,
) -> bool:
    """Write a lower bound of each tip's clearance to the deformed surface, m, into `work.bounds`.

    The bounds are -inf without screening. Returns True if no tip can touch the surface.

    - inside: row of `model.angles` of the step.
    - opening: added to the radius of the surface, m.
    - after: the motion at the step.
    - deformation: the casing's at the step.
    - enough: `radial_margin` of the margin within which blades are solved together, m.
    """
    n_blades, n_casing = work.gap.shape[0], work.rows.shape[1]
    if not model.laws.screen:
        for k in range(n_blades):
            work.bounds[k] = -math.inf
        return False
    angles, start, tip_shift = model.angles, after.q.shape[0] - n_casing, model.laws.tip_shift
    cosine, sine = angles.cos_orders[inside], angles.sin_orders[inside]
    clearance_bounds(model.surface, model.tips, after.tips, opening, tip_shift, cosine, sine, work.bounds)
    for j in range(n_casing):
        work.casing[j] = after.q[start + j]
    return tighten(
        model.surface, model.tips, work.casing, after.tips, angles.theta[inside], cosine, sine, opening, tip_shift,
        deformation, enough, work.bounds,
    )  # fmt: skip


@inlined_kernel
def try_margin(
    model: Model,
    step: int,
    opening: FloatArray,
    coordinates: Coordinates,
    motions: tuple[Motion, Motion],
    deformation: Deformation,
    margin: float,
    state: State,
) -> tuple[int, int, float]:
    """Solve for the contacts of the blades within a margin. Return a code, their number, and the largest approach, m.

    The code is OK or CONTACT_UNSOLVED. The approach is that of `largest_approach`. It is 0 without contacts, and where
    all blades were solved: no larger margin would then change the result. Where forces were solved, q* is kept in
    `state.scratch.free`.

    - step, opening: as in `contact_step`.
    - deformation: bounds of the casing's deformation in q*.
    - coordinates: q of both motions and of step n.
    - motions: at step n - 1, and q*, which is changed to q_n+1.
    - margin: in m.
    """
    surface, laws, angles, work, scratch = model.surface, model.laws, model.angles, state.contact, state.scratch
    before, after = motions
    n_blades, start = work.gap.shape[0], after.q.shape[0] - work.rows.shape[1]
    new, inside = opening[step + 2], step + 1
    enough = radial_margin(surface, deformation, margin)
    apart = bound_clearances(model, inside, new, after, deformation, enough, work)
    if apart and not laws.lasting:
        for k in range(n_blades):
            work.step_gaps[2, k] = math.nan
        return OK, 0, 0.0
    count, penetrates = find_near(
        surface, model.tips, state.wear.depth, after.q, after.tips, start, new, angles.cosine[inside],
        angles.sine[inside], margin, enough, work,
    )  # fmt: skip
    touches = count > 0 and (penetrates or laws.restitution > 0.0)
    for k in range(n_blades):  # later works begin with it: it must not depend on the bounds
        work.step_gaps[2, k] = work.gap[k] if touches or laws.lasting else math.nan
    if not touches:
        return OK, 0, 0.0
    recover_contacts(count, model, before, work)
    recover_contacts(count, model, after, work)
    change_contacts(count, before, after, 0.5 / laws.dt, work, scratch.change)
    if solve_contacts(count, model, step, opening, coordinates, state) != SOLVED:
        return CONTACT_UNSOLVED, count, 0.0
    copy_motion(after, scratch.free)
    apply_contacts(count, model, after, state)
    if count == n_blades:
        return OK, count, 0.0
    return OK, count, largest_approach(surface, after.tips, scratch.free.tips, after.q, scratch.free.q, start)


@allocation_free_kernel
def try_larger_margins(
    model: Model,
    step: int,
    opening: FloatArray,
    coordinates: Coordinates,
    motions: tuple[Motion, Motion],
    deformation: Deformation,
    margin: float,
    state: State,
) -> tuple[int, int]:
    """Solve a step again with `margin`, and with ever larger margins. Return OK or CONTACT_UNSOLVED, and the contacts.

    The parameters are as in `try_margin`, which must have left q* in `state.scratch.free`. After MARGIN_TRIES margins,
    the first one counted, the step is unsolved.

    It is a function of its own, which steps hardly ever call: a loop over the margins within a step would let the
    compiler prepare all of a contact before it, in every step.
    """
    for _ in range(MARGIN_TRIES - 1):
        copy_motion(state.scratch.free, motions[1])
        code, count, approach = try_margin(model, step, opening, coordinates, motions, deformation, margin, state)
        if code != OK or approach <= margin:
            return code, count
        margin = larger_margin(model.surface, approach)
    return CONTACT_UNSOLVED, count


@inlined_kernel
def contact_step(
    model: Model,
    step: int,
    opening: FloatArray,
    before: Motion,
    now: Motion,
    after: Motion,
    casing_bound: float,
    state: State,
) -> tuple[int, int]:
    """Turn q* in `after` into q_n+1. Return OK or CONTACT_UNSOLVED, and the number of contacts that were solved.

    If a blade has entered the surface, or with restitution, all blades whose gap in q* is below a margin are solved
    together. The contact forces may close other gaps by at most `largest_approach`. Where that exceeds the margin, the
    step is solved again with a larger margin, so no blade can be missed. After MARGIN_TRIES margins it is unsolved. The
    new gaps, as far as they are known, are left in `work.step_gaps[2]`.

    - step: number of the step n in `model.angles`.
    - opening (steps + 2,): added to the radius of the surface at steps -1, 0, ..., m.
    - before, now: motion at steps n - 1 and n.
    - after: q*, the motion at step n + 1 without contact; changed to q_n+1.
    - casing_bound: bound of the casing's displacement in q*, m.
    """
    work, motions = state.contact, (before, after)
    coordinates = Coordinates(before.q, now.q, after.q, state.scratch.change)
    deformation = deformation_bounds(model.surface, after.q[after.q.shape[0] - work.rows.shape[1] :], casing_bound)
    margin = starting_margin(model.laws, work.step_gaps)
    code, count, approach = try_margin(model, step, opening, coordinates, motions, deformation, margin, state)
    if not approach <= margin:
        margin = larger_margin(model.surface, approach)
        code, count = try_larger_margins(model, step, opening, coordinates, motions, deformation, margin, state)
    if code != OK:
        return code, count
    for m in range(count):
        gap = work.gap[work.blade[m]]
        for column in range(count):
            gap += work.W[m, column] * work.lam[column]
        work.step_gaps[2, work.blade[m]] = gap
    return OK, count
