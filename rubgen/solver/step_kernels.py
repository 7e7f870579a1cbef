"""One step of the central difference scheme with Lagrange multipliers, in forward increments.

    A     = M / dt^2 + C / (2 dt)
    q*    = A^-1 [f - K q_n + 2 M / dt^2 q_n - (M / dt^2 - C / (2 dt)) q_n-1]
    q_n+1 = q* + A^-1 B lam,   0 <= lam  _|_  g(q*) + e g_n-1 + W lam >= 0

(Carpenter, Taylor, Katona 1991; restitution e of Paoli and Schatzman.) Contact alone couples blisk and casing, so each
has its own block.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from rubgen.arrays import FloatArray
from rubgen.contact.contact_kernels import (
    ContactWork,
    apply_contacts,
    build_compliance,
    build_response,
    build_rows,
    find_near,
    gap_at,
    largest_approach,
)
from rubgen.contact.geometry_kernels import Surface, Tips, clearance_bounds
from rubgen.contact.lcp_kernels import SOLVED, solve_lcp
from rubgen.jit import allocation_free_kernel

OK, CONTACT_UNSOLVED, DIVERGED, ENERGY = 0, 1, 2, 3
MARGIN_TRIES = 6


class Block(NamedTuple):
    """The scheme's matrices of one uncoupled block of size m: row j holds column j, padded with zeros.

    q* = sum_j now[j] q_n,j + before[j] q_n-1,j + constant; `inverse[j]` is column j of A^-1.
    """

    now: FloatArray
    before: FloatArray
    constant: FloatArray
    inverse: FloatArray


class Laws(NamedTuple):
    """Numbers of the step: Omega, dt, friction, restitution; lengths in m; screening on or off.

    `margin` is the candidates' least one; a casing node displaced by more than `casing_limit` or a tip by more than
    `tip_limit` in one direction means divergence.
    """

    speed: float
    dt: float
    friction: float
    restitution: float
    margin: float
    casing_limit: float
    tip_limit: float
    screen: bool


class Angles(NamedTuple):
    """Tables over the steps of one turn, each with one row more than steps (the last is the first of the next turn).

    `cosine`, `sine` of theta; `cos_orders`, `sin_orders` (steps + 1, n_harmonics) of order_j (theta - phase_j).
    """

    cosine: FloatArray
    sine: FloatArray
    cos_orders: FloatArray
    sin_orders: FloatArray


class State(NamedTuple):
    """q at steps n - 1, n, n + 1, each (n,), and scratch: d or the velocity (n,), one padded vector for each block."""

    before: FloatArray
    now: FloatArray
    after: FloatArray
    change: FloatArray
    blisk_sum: FloatArray
    casing_sum: FloatArray


@allocation_free_kernel
def add_columns(columns: FloatArray, x: FloatArray, sum_out: FloatArray) -> None:
    """sum_out += sum_j columns[j] x[j]; four columns at a time, vectorised along the padded rows."""
    quads = x.shape[0] // 4 * 4
    width = sum_out.shape[0]
    for j in range(0, quads, 4):
        a, b, c, d = x[j], x[j + 1], x[j + 2], x[j + 3]
        first, second, third, fourth = columns[j], columns[j + 1], columns[j + 2], columns[j + 3]
        for i in range(width):
            sum_out[i] += a * first[i] + b * second[i] + c * third[i] + d * fourth[i]
    for j in range(quads, x.shape[0]):
        a, first = x[j], columns[j]
        for i in range(width):
            sum_out[i] += a * first[i]


@allocation_free_kernel
def free_step(block: Block, before: FloatArray, now: FloatArray, after_out: FloatArray, sum_work: FloatArray) -> None:
    """q* of one block."""
    for i in range(sum_work.shape[0]):
        sum_work[i] = block.constant[i]
    add_columns(block.now, now, sum_work)
    add_columns(block.before, before, sum_work)
    for i in range(after_out.shape[0]):
        after_out[i] = sum_work[i]


@allocation_free_kernel
def previous_gap(
    surface: Surface,
    tips: Tips,
    blade: int,
    state: State,
    opening: float,
    cosine: float,
    sine: float,
    work: ContactWork,
) -> float:
    """The gap of a blade at step n - 1: the scheme's own value where it was near, else from the geometry."""
    held: float = work.held[0, blade]
    if math.isnan(held):
        start = state.now.shape[0] - work.rows.shape[1]
        held = gap_at(surface, tips, blade, state.before, start, opening, cosine, sine, work.ends)
        work.held[0, blade] = held
    return held


@allocation_free_kernel
def starting_margin(laws: Laws, held: FloatArray) -> float:
    """The least margin, widened by restitution times the deepest gap held at step n - 1."""
    deepest = 0.0
    if laws.restitution > 0.0:
        for k in range(held.shape[1]):
            if held[0, k] < deepest:
                deepest = held[0, k]
    return laws.margin - laws.restitution * deepest


@allocation_free_kernel
def solve_contacts(
    count: int,
    surface: Surface,
    tips: Tips,
    blisk: Block,
    casing: Block,
    laws: Laws,
    angles: Angles,
    step: int,
    opening: FloatArray,
    state: State,
    work: ContactWork,
) -> int:
    """The multipliers of the near blades at q* (in `state.after`), solved together; SOLVED or UNSOLVED."""
    last = angles.cosine.shape[0] - 1
    back = step - 1 if step > 0 else last - 1
    for i in range(state.change.shape[0]):
        state.change[i] = (state.after[i] - state.before[i]) / (2 * laws.dt)
    for m in range(count):
        k = work.blade[m]
        build_rows(
            surface, tips, m, state.after, state.change, laws.speed, laws.friction,
            angles.cosine[step + 1], angles.sine[step + 1], work,
        )  # fmt: skip
        build_response(m, blisk.inverse, casing.inverse, work)
        work.b[m] = work.gap[k]
        if laws.restitution > 0.0:
            held = previous_gap(surface, tips, k, state, opening[step], angles.cosine[back], angles.sine[back], work)
            work.b[m] += laws.restitution * held
    build_compliance(count, work)
    return solve_lcp(work.W, work.b, count, work.lam, work.square, work.tableau, work.basis)


@allocation_free_kernel
def contact_step(
    surface: Surface,
    tips: Tips,
    blisk: Block,
    casing: Block,
    laws: Laws,
    angles: Angles,
    step: int,
    opening: FloatArray,
    state: State,
    work: ContactWork,
) -> tuple[int, int]:
    """Turn q* in `state.after` into q_n+1; OK or CONTACT_UNSOLVED, and the number of contacts that were solved.

    Only blades whose free gap is below the margin enter. What the forces then close is bounded; where it exceeds the
    margin, the margin is widened and the step solved again, so no blade can be missed.
    """
    n_blades = work.bounds.shape[0]
    start = state.now.shape[0] - work.rows.shape[1]
    new, inside = opening[step + 2], step + 1
    margin = starting_margin(laws, work.held)
    clearance_bounds(surface, tips, state.after, new, angles.cos_orders[inside], angles.sin_orders[inside], work.bounds)
    for _ in range(MARGIN_TRIES):
        count, penetrates = find_near(
            surface,
            tips,
            state.after,
            start,
            new,
            angles.cosine[inside],
            angles.sine[inside],
            margin,
            laws.screen,
            work,
        )
        for k in range(n_blades):
            work.held[2, k] = work.gap[k]
        if count == 0 or not (penetrates or laws.restitution > 0.0):
            return OK, 0
        if solve_contacts(count, surface, tips, blisk, casing, laws, angles, step, opening, state, work) != SOLVED:
            return CONTACT_UNSOLVED, count
        for i in range(state.now.shape[0]):
            state.change[i] = state.after[i]
        apply_contacts(count, state.after, start, work)
        approach = largest_approach(surface, state.after, state.change, start, n_blades)
        if approach <= margin or count == n_blades:
            break
        margin = 2 * approach
        for i in range(state.now.shape[0]):
            state.after[i] = state.change[i]
    else:
        return CONTACT_UNSOLVED, count
    for m in range(count):
        gap = work.gap[work.blade[m]]
        for column in range(count):
            gap += work.W[m, column] * work.lam[column]
        work.held[2, work.blade[m]] = gap
    return OK, count
