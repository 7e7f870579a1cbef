"""Run some turns of the blisk in one call: steps, works, taps, touches.

z are the coordinates in the order of the blocks (`linalg.blocks`), d = (q_n+1 - q_n-1) / 2.
"""

import math
from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.contact.clearance_kernels import casing_displacement_bound
from rubgen.contact.contact_kernels import wear_where_lined
from rubgen.jit import allocation_free_kernel, inlined_kernel
from rubgen.linalg.harmonic_kernels import Harmonics, recover_all
from rubgen.solver.scheme.contact_step_kernels import change_contacts, recover_contacts
from rubgen.solver.scheme.energy_kernels import (
    ABSOLUTE,
    add_contact_works,
    add_waiting_works,
    book_linear_works,
    stored_energy,
)
from rubgen.solver.scheme.model_kernels import Model
from rubgen.solver.scheme.motion_kernels import Motion, motion_at, put_in_order
from rubgen.solver.scheme.state_kernels import OK, Coordinates, Scratch, Snapshots, State, keep_snapshot
from rubgen.solver.scheme.step_kernels import advance, shift_gaps
from rubgen.solver.scheme.tap_kernels import SPEED_X, SPEED_Y, Taps, X, Y, record_arrivals, record_taps
from rubgen.solver.supports.support_kernels import add_support_works

BLADE, START, STEPS, COSINE, SINE, IMPULSE, FRICTION_LOSS, NORMAL_LOSS = range(8)


class Touches(NamedTuple):
    """Touches of the blades. Columns of a touch: BLADE, START, STEPS, COSINE, SINE, IMPULSE and the two losses."""

    open: FloatArray
    """The present touch of each blade (n_blades, 8); STEPS is 0 without one."""
    last: IntArray
    """Last step with a force on each blade (n_blades,)."""
    ended: FloatArray
    """Touches that ended in the turn (rows, 8). n_blades (steps / 2 + 2) rows are enough for all."""


class TurnResult(NamedTuple):
    """Outputs of a turn or part of a turn; of several turns, every array has a row for each."""

    taps: FloatArray
    """True signals (taps, steps)."""
    section: FloatArray
    """q and v at the Poincare section beside the start (2, n)."""
    summary: FloatArray
    """Impulse in N s, steps with contact, largest bound of the casing's displacement in m, number of arrivals (4,)."""
    orbit: FloatArray
    """Sums over the steps (5,), see `add_orbit`."""
    frames: FloatArray
    """z at equal steps from the first step on (frames, size of z); at most one frame for each step."""


@allocation_free_kernel
def close_touch(touches: Touches, blade: int, ended: int) -> int:
    """Move a blade's present touch to `touches.ended`.

    Return the new number of ended touches; `ended` is the old number.
    """
    for c in range(touches.open.shape[1]):
        touches.ended[ended, c] = touches.open[blade, c]
    touches.open[blade, STEPS] = 0.0
    return ended + 1


@allocation_free_kernel
def add_touch(
    touches: Touches, blade: int, now: int, psi: float, impulse: float, friction: float, normal: float, ended: int
) -> int:
    """Add one step of contact to the blade's present touch. A touch that was interrupted before is ended.

    `now` is the number of the step, `psi` the polar angle of the contact (rad). `impulse` (N s), `friction` and
    `normal` (losses, J) belong to the step. Returns the new number of ended touches; `ended` is the old number.
    """
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
    """End all touches without a force at step `now`.

    Return the new number of ended touches; `ended` is the old number.
    """
    for k in range(touches.last.shape[0]):
        if touches.open[k, STEPS] > 0.0 and touches.last[k] < now:
            ended = close_touch(touches, k, ended)
    return ended


@allocation_free_kernel
def record_section(
    harmonics: Harmonics,
    tau: float,
    dt: float,
    before: Motion,
    now: Motion,
    after: Motion,
    scratch: Scratch,
    section_out: FloatArray,
) -> None:
    """Write q and v at the Poincare section into `section_out` (2, n), from the parabola through steps -1, 0 and 1.

    q = q_0 + tau d + tau^2 / 2 (q_1 - 2 q_0 + q_-1), and v is its derivative. tau is `Angles.section` in steps, 0 at a
    steady speed. The error is of third order in dt for q, of second order for v, like the central difference. `before`,
    `now` and `after` are the motions at steps -1, 0 and 1. `scratch.z_change` must contain d = (z_1 - z_-1) / 2; it is
    overwritten.
    """
    if tau == 0.0:
        recover_all(harmonics, now.z, scratch.share, scratch.tips, section_out[0])
        recover_all(harmonics, scratch.z_change, scratch.share, scratch.tips, section_out[1])
    else:
        for i in range(scratch.z_force.shape[0]):
            bend = after.z[i] - 2 * now.z[i] + before.z[i]
            scratch.z_force[i] = now.z[i] + tau * (scratch.z_change[i] + 0.5 * tau * bend)
            scratch.z_change[i] += tau * bend
        recover_all(harmonics, scratch.z_force, scratch.share, scratch.tips, section_out[0])
        recover_all(harmonics, scratch.z_change, scratch.share, scratch.tips, section_out[1])
    for i in range(section_out.shape[1]):
        section_out[1, i] /= dt


@inlined_kernel
def add_orbit(signals: FloatArray, out: FloatArray) -> None:
    """Add X, Y, X^2 + Y^2, V_X^2 + V_Y^2 and X V_Y - Y V_X of the disk centre, inertial, to `out` (5,).

    `signals` are the signals of the shaft at one step, in m and m/s.
    """
    x, y, vx, vy = signals[X], signals[Y], signals[SPEED_X], signals[SPEED_Y]
    out[0] += x
    out[1] += y
    out[2] += x * x + y * y
    out[3] += vx * vx + vy * vy
    out[4] += x * vy - y * vx


@inlined_kernel
def record_frame(frames: FloatArray, frame: int, step: int, steps: int, z: FloatArray) -> int:
    """Copy z into `frames` if a frame is due at `step`. Return the new number of frames; `frame` is the old number.

    Frames are due at equal steps of the `steps` steps: frame i at step ceil(i steps / frames).
    """
    if step * frames.shape[0] < frame * steps:
        return frame
    for i in range(z.shape[0]):
        frames[frame, i] = z[i]
    return frame + 1


@inlined_kernel
def add_contacts(
    count: int,
    model: Model,
    step: int,
    clock: int,
    opening: FloatArray,
    coordinates: Coordinates,
    state: State,
    touches: Touches,
    summary: FloatArray,
    ended: int,
) -> tuple[float, float, int]:
    """Add the contacts of one step to works, touches and `summary`. Return force, N, torque, N m, and ended touches.

    - count: number of contacts in `state.contact`.
    - step: number of the step in the turn.
    - clock: number of the turn's first step in the run.
    - opening (steps + 2,): added to the radius of the surface at steps -1, 0, ..., m.
    - coordinates: of the contacts' blades the tip coordinates must be valid. `change` is d = (q_n+1 - q_n-1) / 2.
    - summary (4,): as in `TurnResult`; changed.
    - ended: number of ended touches before.
    """
    work, force, torque, dt = state.contact, 0.0, 0.0, model.laws.dt
    for m in range(count):
        lam, k = work.lam[m], work.blade[m]
        if lam > 0.0:
            normal, friction, brake = add_contact_works(m, model, step, opening, coordinates, state)
            ended = add_touch(touches, k, clock + step, work.psi[k], lam * dt, friction, normal, ended)
            force, torque = force + lam, torque + brake
    if force > 0.0:
        summary[0] += force * dt
        summary[1] += 1
    return force, torque, ended


@inlined_kernel
def run_turn(
    model: Model,
    opening: FloatArray,
    clock: int,
    recording: bool,
    state: State,
    taps: Taps,
    touches: Touches,
    snapshots: Snapshots,
    result: TurnResult,
) -> tuple[int, int, int]:
    """Integrate one turn, or part of it, as `run_turns` does. Return code, step of the end, number of ended touches.

    The code is OK, or that of a step that fails (`step_kernels`). The turn ends there, and present touches go on.
    """
    laws, steps = model.laws, model.angles.cosine.shape[0] - 2
    work, scratch = state.contact, state.scratch
    buffer, first, second, third = state.buffer, 0, 1, 2
    ended = arrivals = frame = number = waiting = 0
    result.summary[:] = 0.0
    result.orbit[:] = 0.0
    for s in range(steps):
        before, now, after = motion_at(buffer, first), motion_at(buffer, second), motion_at(buffer, third)
        if snapshots.steps[number] == s:
            number = keep_snapshot(snapshots, number, before, now, work)
        code, count = advance(model, s, opening, before, now, after, state)
        if code != OK:
            add_waiting_works(model.energy, waiting, laws.dt, scratch.waiting, state.works)
            put_in_order(buffer, first)
            return code, s, ended
        coordinates = Coordinates(before.q, now.q, after.q, scratch.change)
        for i in range(scratch.z_change.shape[0]):
            scratch.z_change[i] = 0.5 * (after.z[i] - before.z[i])
        waiting = book_linear_works(
            model.energy, now.z, scratch.z_change, laws.dt, waiting, scratch.waiting, state.works
        )
        if model.support.active:
            cosine, sine = model.angles.cosine[s], model.angles.sine[s]
            state.works[ABSOLUTE] += add_support_works(
                model.support, laws.speed, laws.dt, cosine, sine, now.z, scratch.z_change, state.support
            )
        force, torque = 0.0, 0.0
        if count > 0:
            recover_contacts(count, model, after, work)  # `after` has moved; `before` was recovered in the contact step
            change_contacts(count, before, after, 0.5, work, scratch.change)
            force, torque, ended = add_contacts(
                count, model, s, clock, opening, coordinates, state, touches, result.summary, ended
            )
        if recording:
            record_taps(model, taps, coordinates, state, now, s, opening[s + 1], force, torque, result.taps)
            add_orbit(taps.signals, result.orbit)
            if taps.timing.angle.shape[0] > 0:
                arrivals = record_arrivals(
                    model.harmonics, model.tips, model.angles.theta, taps.timing, (before, now, after), s, clock,
                    arrivals,
                )  # fmt: skip
        frame = record_frame(result.frames, frame, s, steps, now.z)
        if s == 0:
            record_section(model.harmonics, model.angles.section, laws.dt, before, now, after, scratch, result.section)
        displacement = casing_displacement_bound(model.surface, after.q[after.q.shape[0] - taps.bend.shape[0] :])
        result.summary[2] = max(result.summary[2], displacement)
        first, second, third = second, third, first
        wear_where_lined(count, model.surface.liner, laws.dt, work, state.wear)
        shift_gaps(work)
    add_waiting_works(model.energy, waiting, laws.dt, scratch.waiting, state.works)
    keep_snapshot(snapshots, number, motion_at(buffer, first), motion_at(buffer, second), work)
    put_in_order(buffer, first)
    ended = close_touches(touches, clock + steps - 1, ended)
    result.summary[3] = arrivals
    return OK, steps, ended


class TurnEnds(NamedTuple):
    """Touches, works and energy of some turns, a row for each turn."""

    touches: IntArray
    """Number of touches that ended in the turn (turns,)."""
    works: FloatArray
    """Works after the turn (turns, 8), J, at the indices of `energy_kernels`."""
    support_works: FloatArray
    """Works of the supports after it (turns, 5), J."""
    energy: FloatArray
    """Stored energy half a step before its end (turns,), J."""


@allocation_free_kernel
def run_turns(
    model: Model,
    opening: FloatArray,
    clock: int,
    recording: bool,
    state: State,
    taps: Taps,
    touches: Touches,
    snapshots: Snapshots,
    results: TurnResult,
    ends: TurnEnds,
) -> tuple[int, int, int]:
    """Integrate turns, or parts of turns, one after another: one call is faster than a call for each turn.

    Return a code, the number of turns without a failed step, and the step where the last turn ended. The code is OK, or
    the code of the turn that failed (`run_turn`). No turn follows it, and outputs of its later steps are not written;
    its row of `ends` is.

    - model: constants; its `angles` have the steps.
    - opening (turns, steps + 2): added to the radius of the surface at steps -1, 0, ..., steps of each turn, m.
    - clock: number of the first step of the first turn in the run.
    - recording: False leaves out taps, orbit and arrivals. The motion is the same.
    - state: changed to the state at the end. `state.buffer` has the motions at steps -1 and 0, then at the last two.
    - taps: true signals of the present step n, with the contact force lam_n of the same time; changed.
    - touches, results, ends: written. `touches.ended` has a row for each turn. The arrivals in `taps.timing` belong to
      the last turn.
    - snapshots: written at their steps; the last step is the end of a turn or later. Its arrays except `steps` have a
      row for each turn.
    """
    code, step, steps = OK, 0, model.angles.cosine.shape[0] - 2
    for t in range(opening.shape[0]):
        code, step, ends.touches[t] = run_turn(
            model,
            opening[t],
            clock + t * steps,
            recording,
            state,
            taps,
            Touches(touches.open, touches.last, touches.ended[t]),
            Snapshots(snapshots.steps, snapshots.z[t], snapshots.step_gaps[t]),
            TurnResult(results.taps[t], results.section[t], results.summary[t], results.orbit[t], results.frames[t]),
        )
        before, now = state.buffer.z[0], state.buffer.z[1]
        for i in range(now.shape[0]):
            state.scratch.z_change[i] = now[i] - before[i]
        ends.energy[t] = stored_energy(model.energy, before, now, state.scratch.z_change, model.laws.dt)
        for i in range(state.works.shape[0]):
            ends.works[t, i] = state.works[i]
        for i in range(state.support.works.shape[0]):
            ends.support_works[t, i] = state.support.works[i]
        if code != OK:
            return code, t, step
    return code, opening.shape[0], step
