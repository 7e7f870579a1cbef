"""A linear system whose first coordinate may not go below zero, stepped by the solver's own scheme."""

from __future__ import annotations

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.contact.lcp_kernels import RIGID
from rubgen.linalg.blocks import aligned, find_blocks
from rubgen.solver.scheme.central_difference import scheme
from validation.verification.contact.wall_kernels import WallWork, steps_against_wall


class Wall:
    """Central differences with a Lagrange multiplier against a wall at q_0 = 0; undamped, restitution e.

    `before` and `now` (n,) are q at steps n - 1 and n. K must couple all coordinates: then they are one block, and z
    begins with q.
    """

    def __init__(self, M: FloatArray, K: FloatArray, dt: float, restitution: float = 0.0) -> None:
        n = len(M)
        self.dt, self.restitution = dt, restitution
        blocks = find_blocks([M, K], 0)
        self.scheme = scheme(M, np.zeros((n, n)), K, np.zeros(n), dt, blocks)
        before, now, after = (aligned(blocks.to_z(np.zeros(n))) for _ in range(3))
        self.before, self.now = before[:n], now[:n]
        one = np.zeros((1, 1))
        self._work = WallWork(
            before=before, now=now, after=after, response=blocks.to_z(np.linalg.inv(M / dt**2)[0]),
            law=np.array([RIGID]), W=one.copy(), b=np.zeros(1), lam=np.zeros(1), square=one, tableau=np.zeros((1, 4)),
            basis=np.zeros(1, dtype=np.int64),
        )  # fmt: skip

    def run(self, force: FloatArray) -> FloatArray:
        """Advance by one step for each entry of `force` (steps,) on q_0; the contact force at each (steps,)."""
        contact_force = np.zeros(len(force))
        if not steps_against_wall(self.scheme, self.restitution, force, self._work, contact_force):
            raise ArithmeticError("no contact force found at the wall")
        return contact_force
