"""The elastic bar that bounces off a wall (d'Alembert): plateau rho c v0 A, contact time 2 L / c, rebound speed v0."""

import numpy as np
import pytest

from rubgen.contact import solve_complementarity
from rubgen.solver.central_difference import scheme_block
from rubgen.solver.step_kernels import free_step

E, RHO, LENGTH, AREA, SPEED = 900.0, 1.0, 10.0, 1.0, 10.0
WAVE = np.sqrt(E / RHO)


def bar(elements):
    h = LENGTH / elements
    K, M = np.zeros((2, elements + 1, elements + 1))
    for e in range(elements):
        part = np.ix_([e, e + 1], [e, e + 1])
        K[part] += E * AREA / h * np.array([[1, -1], [-1, 1]])
        M[part] += RHO * AREA * h / 2 * np.eye(2)
    return M, K


def bounce(elements):
    """Times, contact force and node speeds of a bar whose node 0 meets a wall at x = 0."""
    M, K = bar(elements)
    n = len(M)
    dt = 0.5 * LENGTH / elements / WAVE
    block = scheme_block(M, np.zeros((n, n)), K, np.zeros(n), dt)
    inverse = block.inverse[:, :n].T
    now = np.zeros(n)
    before = now + SPEED * dt
    after, scratch = np.zeros(n), np.zeros(block.now.shape[1])
    forces, speeds = [], []
    for _ in range(int(2.0 * 2 * LENGTH / WAVE / dt)):
        free_step(block, before, now, after, scratch)
        lam = solve_complementarity(inverse[:1, :1], after[:1])[0]
        after += inverse[:, 0] * lam
        forces.append(lam)
        speeds.append((after - before) / (2 * dt))
        before, now = now, after.copy()
    return dt, np.array(forces), np.array(speeds)


def test_plateau_contact_time_and_rebound():
    dt, force, speed = bounce(200)
    duration = 2 * LENGTH / WAVE
    time = dt * np.arange(len(force))
    plateau = force[(time > 0.1 * duration) & (time < 0.9 * duration)]
    assert plateau.mean() == pytest.approx(RHO * WAVE * SPEED * AREA, rel=0.01)
    assert force.sum() * dt == pytest.approx(2 * RHO * LENGTH * AREA * SPEED, rel=0.02)
    assert time[np.flatnonzero(force)[-1]] == pytest.approx(duration, rel=0.03)
    weights = np.diag(bar(200)[0])
    assert speed[-1] @ weights / weights.sum() == pytest.approx(SPEED, rel=0.02)
