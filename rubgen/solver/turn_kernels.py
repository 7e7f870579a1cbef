"""One turn of the blisk in one call: steps, energy book, taps, touches."""

from __future__ import annotations

import math
from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.contact.clearance_kernels import casing_reach
from rubgen.contact.contact_kernels import ContactWork
from rubgen.contact.geometry_kernels import Tips
from rubgen.jit import allocation_free_kernel, inlined_kernel
from rubgen.solver.block_kernels import Motion, recover_all
from rubgen.solver.energy_kernels import Book, book_contact, book_linear
from rubgen.solver.lanes_kernels import add_lines
from rubgen.solver.mark_kernels import Marks, keep_mark
from rubgen.solver.model_kernels import Model, Scratch, State
from rubgen.solver.step_kernels import OK, advance, recover_contacts, shift_held

BLADE, START, STEPS, COSINE, SINE, IMPULSE, FRICTION_LOSS, NORMAL_LOSS = range(8)
ACCELERATIONS, RAYS = 4, 2


class Taps(NamedTuple):
    """What the taps need.

    `casing` (2 n_casing, 8), rows of eight, mode by mode: radial displacement at the four accelerometers, then for each
    of two rays the radial and tangential displacement and the derivative of the radial one. `ray_radius`, `ray_slope`
    (2,) of the undeformed surface there; `ray_blade` (steps, 2, 2) the blades before and after the ray and `ray_share`
    (steps, 2) the way between them. `centre` the index of O_d x. `sums`, `bend` are scratch,
    `lines` those of `casing`.
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
    bend: FloatArray
    lines: IntArray


class Touches(NamedTuple):
    """Touches under way: `open` (n_blades, 8), `last` (n_blades,) last step with force; `ended` (many, 8)."""

    open: FloatArray
    last: IntArray
    ended: FloatArray


class TurnResult(NamedTuple):
    """Outputs of a turn: `taps` (11, steps), section (2, n): q and v at its start, `summary` (3,), `frames`.

    `summary`: impulse in N s, steps with contact, largest bound of the casing's displacement in m. `frames` (any, any)
    hold z at equal steps from the turn's first on; at most one a step.
    """

    taps: FloatArray
    section: FloatArray
    summary: FloatArray
    frames: FloatArray


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


@inlined_kernel
def tip_radius_on_ray(tips: Tips, taps: Taps, displacement: FloatArray, step: int, ray: int) -> float:
    """Radius of the tips on a ray: linear in angle between the two blades around it."""
    radius = 0.0
    for side in range(2):
        k = taps.ray_blade[step, ray, side]
        radial = tips.radius + tips.static[0, k] + displacement[0, k]
        tangential = tips.static[1, k] + displacement[1, k]
        share = taps.ray_share[step, ray] if side == 1 else 1 - taps.ray_share[step, ray]
        radius += share * math.sqrt(radial * radial + tangential * tangential)
    return radius


@inlined_kernel
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


@inlined_kernel
def record_casing(taps: Taps, state: State, dt: float) -> None:
    """Into `taps.sums`: the casing's accelerations, then its displacements at rays."""
    n_casing, start = taps.bend.shape[0], state.now.shape[0] - taps.bend.shape[0]
    for j in range(start, start + n_casing):
        taps.bend[j - start] = (state.after[j] - 2 * state.now[j] + state.before[j]) / (dt * dt)
    taps.sums[:, :] = 0.0
    add_lines(taps.lines, taps.casing, taps.bend, taps.sums[0])
    add_lines(taps.lines, taps.casing, state.now[start:], taps.sums[1])


@inlined_kernel
def record_taps(
    model: Model,
    taps: Taps,
    state: State,
    displacement: FloatArray,
    step: int,
    opening: float,
    force: float,
    out: FloatArray,
) -> None:
    """All taps at step n, where q is `state.now`, velocity and acceleration are central differences.

    `displacement` (2, any) is that of the tips at step n.
    """
    speed, dt = model.laws.speed, model.laws.dt
    cosine, sine = model.angles.cosine[step], model.angles.sine[step]
    record_casing(taps, state, dt)
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
        tip = tip_radius_on_ray(model.tips, taps, displacement, step, ray)
        out[9 + ray, step] = casing_radius_on_ray(taps, opening, ray) - tip


@allocation_free_kernel
def record_section(model: Model, now: Motion, scratch: Scratch, section_out: FloatArray) -> None:
    """The q and v (2, n) at the turn's first step."""
    recover_all(model.harmonics, now.z, scratch.share, scratch.tips, section_out[0])
    recover_all(model.harmonics, scratch.z_change, scratch.share, scratch.tips, section_out[1])
    for i in range(section_out.shape[1]):
        section_out[1, i] /= model.laws.dt


@inlined_kernel
def record_frame(frames: FloatArray, frame: int, step: int, steps: int, z: FloatArray) -> int:
    """Copy z where the next frame is due; the number of frames so far."""
    if step * frames.shape[0] < frame * steps:
        return frame
    for i in range(z.shape[0]):
        frames[frame, i] = z[i]
    return frame + 1


@allocation_free_kernel
def run_turn(
    model: Model,
    opening: FloatArray,
    clock: int,
    motions: tuple[Motion, Motion, Motion],
    work: ContactWork,
    scratch: Scratch,
    book: Book,
    taps: Taps,
    touches: Touches,
    marks: Marks,
    result: TurnResult,
) -> tuple[int, int, int]:
    """Integrate one turn from theta = start; a code, the step where it ended, and the number of ended touches.

    `opening` (steps + 2,) widens the surface at steps -1, 0, ..., steps of the turn. `clock` is the number of the
    turn's first step. `motions` are those at step -1, at step 0 and one to write; they change places with every step.
    Taps of step n carry the force lam_n that acts at that time. The last of `marks` is the turn's end.
    """
    laws, steps = model.laws, model.angles.cosine.shape[0] - 1
    before, now, after = motions
    ended = frame = mark = 0
    result.summary[:] = 0.0
    for s in range(steps):
        if marks.steps[mark] == s:
            mark = keep_mark(marks, mark, before, now, work)
        code, count = advance(model, s, opening, before, now, after, work, scratch)
        if code != OK:
            return code, s, ended
        state = State(before.q, now.q, after.q, scratch.change)
        for i in range(scratch.z_change.shape[0]):
            scratch.z_change[i] = 0.5 * (after.z[i] - before.z[i])
        book_linear(book, now.z, scratch.z_change, laws.dt)
        force = 0.0
        if count > 0:
            recover_contacts(count, model, before, after, 0.5, work, scratch.change)
        for m in range(count):
            lam = work.lam[m]
            if lam > 0.0:
                force += lam
                normal, friction = book_contact(
                    m, model.surface, model.tips, laws, model.angles, s, opening, state, work, book
                )
                k = work.blade[m]
                ended = add_touch(touches, k, clock + s, work.psi[k], lam * laws.dt, friction, normal, ended)
        if force > 0.0:
            result.summary[0] += force * laws.dt
            result.summary[1] += 1
        record_taps(model, taps, state, now.tips, s, opening[s + 1], force, result.taps)
        frame = record_frame(result.frames, frame, s, steps, now.z)
        if s == 0:
            record_section(model, now, scratch, result.section)
        reach = casing_reach(model.surface, after.q[after.q.shape[0] - taps.bend.shape[0] :])
        result.summary[2] = max(result.summary[2], reach)
        before, now, after = now, after, before
        shift_held(work)
    keep_mark(marks, mark, before, now, work)
    ended = close_touches(touches, clock + steps - 1, ended)
    return OK, steps, ended
