"""Many steps of a linear system against one wall, with the solver's free step and complementarity problem."""

from __future__ import annotations

from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.contact.lcp_kernels import SOLVED, solve_normal
from rubgen.jit import allocation_free_kernel
from rubgen.solver.scheme.free_step_kernels import Scheme, free_step


class WallWork(NamedTuple):
    """q at steps n - 1, n, n + 1 and the first column of A^-1, all as z, and scratch of the problem of one contact."""

    before: FloatArray
    now: FloatArray
    after: FloatArray
    response: FloatArray
    law: FloatArray
    W: FloatArray
    b: FloatArray
    lam: FloatArray
    square: FloatArray
    tableau: FloatArray
    basis: IntArray


@allocation_free_kernel
def steps_against_wall(
    scheme: Scheme, restitution: float, force: FloatArray, work: WallWork, contact_force_out: FloatArray
) -> bool:
    """One step for each entry of `force` (steps,), which acts on q_0; the multipliers into `contact_force_out`.

    0 <= lam _|_ q*_0 + e q_n-1,0 + W lam >= 0. False when a step's problem was not solved.
    """
    n = work.now.shape[0]
    work.W[0, 0] = work.response[0]
    for step in range(force.shape[0]):
        free_step(scheme, work.before, work.now, work.after)
        work.b[0] = work.after[0] + force[step] * work.response[0] + restitution * work.before[0]
        if solve_normal(work.law, work.W, work.b, 1, work.lam, work.square, work.tableau, work.basis) != SOLVED:
            return False
        contact_force_out[step] = work.lam[0]
        for i in range(n):
            after = work.after[i] + (force[step] + work.lam[0]) * work.response[i]
            work.before[i] = work.now[i]
            work.now[i] = after
    return True
