"""One turn of the blisk in one call: steps, energy book, taps, touches."""

from __future__ import annotations

import math
from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.contact.contact_kernels import ContactWork
from rubgen.contact.geometry_kernels import Surface, Tips, casing_reach
from rubgen.jit import allocation_free_kernel
from rubgen.solver.energy_kernels import Book, book_contact, book_linear
from rubgen.solver.step_kernels import DIVERGED, OK, Angles, Block, Laws, State, contact_step, free_step

BLADE, START, STEPS, COSINE, SINE, IMPULSE, FRICTION_LOSS, NORMAL_LOSS = range(8)
ACCELERATIONS, RAYS = 4, 2


class Taps(NamedTuple):
    """What the taps need.

    `casing` (n_casing, 10): radial displacement at the four accelerometers, then for each of two rays the radial and
    tangential displacement and the derivative of the radial one. `ray_radius`, `ray_slope` (2,) of the undeformed
    surface there; `ray_blade` (steps, 2, 2) the blades before and after the ray and `ray_share` (steps, 2) the way
    between them. `centre` the index of O_d x.
    """

    casing: FloatArray
    ray_radius: FloatArray
    ray_slope: FloatArray
    ray_blade: IntArray
    ray_share: FloatArray
    centre: int
    lateral_stiffness: float
    lateral_damping: float
    sums: FloatArray


class Touches(NamedTuple):
    """Touches under way: `open` (n_blades, 8), `last` (n_blades,) last step with force; `ended` (many, 8)."""

    open: FloatArray
    last: IntArray
    ended: FloatArray


class TurnResult(NamedTuple):
    """Outputs of a turn: `taps` (11, steps), section (2, n): q and v at its start, `summary` (3,).

    `summary`: impulse in N s, steps with contact, largest bound of the casing's displacement in m.
    """

    taps: FloatArray
    section: FloatArray
    summary: FloatArray


@allocation_free_kernel
def close_touch(touches: Touches, blade: int, ended: int) -> int:
    """Move a blade's touch to the ended ones."""
    for c in range(touches.open.shape[1]):
        touches.ended[ended, c] = touches.open[blade, c]
    touches.open[blade, STEPS] = 0.0
    return ended + 1


@allocation_free_kernel
def add_touch(
    touches: Touches, blade: int, now: int, psi: float, impulse: float, friction: float, normal: float, ended: int
) -> int:
    """Add one step of contact to the blade's touch; an older touch that was interrupted ends first."""
    row = touches.open[blade]
    if row[STEPS] > 0.0 and touches.last[blade] != now - 1:
        ended = close_touch(touches, blade, ended)
    if row[STEPS] == 0.0:
        row[:] = 0.0
        row[BLADE], row[START] = blade, now
    touches.last[blade] = now
    row[STEPS] += 1
    row[COSINE] += impulse * math.cos(psi)
    row[SINE] += impulse * math.sin(psi)
    row[IMPULSE] += impulse
    row[FRICTION_LOSS] += friction
    row[NORMAL_LOSS] += normal
    return ended


@allocation_free_kernel
def close_touches(touches: Touches, now: int, ended: int) -> int:
    """End all touches without force at step `now`; their number in `touches.ended`."""
    for k in range(touches.last.shape[0]):
        if touches.open[k, STEPS] > 0.0 and touches.last[k] < now:
            ended = close_touch(touches, k, ended)
    return ended


@allocation_free_kernel
def largest_nodal_displacement(surface: Surface, q_casing: FloatArray) -> float:
    """The largest displacement of a casing node, m; NaN when any is."""
    largest = 0.0
    for i in range(surface.table.shape[0]):
        x, y = 0.0, 0.0
        for j in range(q_casing.shape[0]):
            x += surface.table[i, j, 0] * q_casing[j]
            y += surface.table[i, j, 1] * q_casing[j]
        size = x * x + y * y
        if not size <= largest:
            largest = size
    return math.sqrt(largest)


@allocation_free_kernel
def has_diverged(surface: Surface, laws: Laws, q: FloatArray, casing_start: int, n_blades: int) -> bool:
    """Whether a casing node or a blade tip has moved beyond its limit, or is not a number."""
    for k in range(3 * n_blades):
        if not abs(q[k]) <= laws.tip_limit:
            return True
    q_casing = q[casing_start:]
    if casing_reach(surface, q_casing) <= laws.casing_limit:
        return False
    return not largest_nodal_displacement(surface, q_casing) <= laws.casing_limit


@allocation_free_kernel
def tip_radius_on_ray(tips: Tips, taps: Taps, q: FloatArray, step: int, ray: int) -> float:
    """Radius of the tips on a ray: linear in angle between the two blades around it."""
    radius = 0.0
    for side in range(2):
        k = taps.ray_blade[step, ray, side]
        radial = tips.radius + tips.static[k, 0] + q[3 * k]
        tangential = tips.static[k, 1] + q[3 * k + 1]
        share = taps.ray_share[step, ray] if side == 1 else 1 - taps.ray_share[step, ray]
        radius += share * math.sqrt(radial * radial + tangential * tangential)
    return radius


@allocation_free_kernel
def casing_radius_on_ray(taps: Taps, opening: float, ray: int) -> float:
    """Radius at which the ray meets the deformed surface, from the displacements in `taps.sums[1]`.

    The point that comes to the ray stood u_t / r before it: r + u_r - (r' + u_r') u_t / r + u_t^2 / (2 r), right to
    second order in the displacements on a circle, where r' = r'' = 0.
    """
    base = ACCELERATIONS + 3 * ray
    radial, tangential, slope = taps.sums[1, base], taps.sums[1, base + 1], taps.sums[1, base + 2]
    radius: float = taps.ray_radius[ray] + opening + radial
    radius -= tangential / radius * (taps.ray_slope[ray] + slope - 0.5 * tangential)
    return radius


@allocation_free_kernel
def record_taps(
    tips: Tips,
    taps: Taps,
    state: State,
    step: int,
    opening: float,
    cosine: float,
    sine: float,
    speed: float,
    dt: float,
    force: float,
    out: FloatArray,
) -> None:
    """All taps at step n, where q is `state.now`, velocity and acceleration are central differences."""
    n, width = state.now.shape[0], taps.casing.shape[1]
    start = n - taps.casing.shape[0]
    taps.sums[:, :] = 0.0
    for j in range(taps.casing.shape[0]):
        now = state.now[start + j]
        bend = (state.after[start + j] - 2 * now + state.before[start + j]) / (dt * dt)
        for c in range(width):
            taps.sums[0, c] += taps.casing[j, c] * bend
            taps.sums[1, c] += taps.casing[j, c] * now
    x, y = state.now[taps.centre], state.now[taps.centre + 1]
    vx = (state.after[taps.centre] - state.before[taps.centre]) / (2 * dt) - speed * y
    vy = (state.after[taps.centre + 1] - state.before[taps.centre + 1]) / (2 * dt) + speed * x
    fx = taps.lateral_stiffness * x + taps.lateral_damping * vx
    fy = taps.lateral_stiffness * y + taps.lateral_damping * vy
    out[0, step] = cosine * x - sine * y
    out[1, step] = sine * x + cosine * y
    for c in range(ACCELERATIONS):
        out[2 + c, step] = taps.sums[0, c]
    out[6, step] = cosine * fx - sine * fy
    out[7, step] = sine * fx + cosine * fy
    out[8, step] = force
    for ray in range(RAYS):
        out[9 + ray, step] = casing_radius_on_ray(taps, opening, ray) - tip_radius_on_ray(
            tips, taps, state.now, step, ray
        )


@allocation_free_kernel
def run_turn(
    surface: Surface,
    tips: Tips,
    blisk: Block,
    casing: Block,
    laws: Laws,
    angles: Angles,
    opening: FloatArray,
    clock: int,
    state: State,
    work: ContactWork,
    book: Book,
    taps: Taps,
    touches: Touches,
    result: TurnResult,
) -> tuple[int, int, int]:
    """Integrate one turn from theta = start; a code, the step where it ended, and the number of ended touches.

    `opening` (steps + 2,) widens the surface at steps -1, 0, ..., steps of the turn. `clock` is the number of the
    turn's first step. Taps of step n (from `state.now`) carry the force lam_n that acts at that time.
    """
    steps, n = angles.cosine.shape[0] - 1, state.now.shape[0]
    start, n_blades = n - taps.casing.shape[0], work.bounds.shape[0]
    ended = 0
    result.summary[:] = 0.0
    for s in range(steps):
        free_step(blisk, state.before[:start], state.now[:start], state.after[:start], state.blisk_sum)
        free_step(casing, state.before[start:], state.now[start:], state.after[start:], state.casing_sum)
        if has_diverged(surface, laws, state.after, start, n_blades):
            return DIVERGED, s, ended
        code, count = contact_step(surface, tips, blisk, casing, laws, angles, s, opening, state, work)
        if code != OK:
            return code, s, ended
        for i in range(n):
            state.change[i] = 0.5 * (state.after[i] - state.before[i])
        book_linear(book, state, laws.dt, start)
        force = 0.0
        for m in range(count):
            lam = work.lam[m]
            if lam > 0.0:
                force += lam
                normal, friction = book_contact(m, surface, tips, laws, angles, s, opening, state, work, book)
                k = work.blade[m]
                ended = add_touch(touches, k, clock + s, work.psi[k], lam * laws.dt, friction, normal, ended)
        if force > 0.0:
            result.summary[0] += force * laws.dt
            result.summary[1] += 1
        record_taps(
            tips, taps, state, s, opening[s + 1], angles.cosine[s], angles.sine[s], laws.speed, laws.dt, force,
            result.taps,
        )  # fmt: skip
        if s == 0:
            for i in range(n):
                result.section[0, i] = state.now[i]
                result.section[1, i] = state.change[i] / laws.dt
        reach = casing_reach(surface, state.after[start:])
        result.summary[2] = max(result.summary[2], reach)
        for i in range(n):
            state.before[i] = state.now[i]
            state.now[i] = state.after[i]
        for k in range(n_blades):
            work.held[0, k] = work.held[1, k]
            work.held[1, k] = work.held[2, k]
    ended = close_touches(touches, clock + steps - 1, ended)
    return OK, steps, ended
