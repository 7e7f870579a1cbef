"""A companion's distance, its way back, and its turn, against dense matrices."""

import numpy as np
import pytest

from rubgen.scenario import ContactLaw
from rubgen.solver.observers.companion_kernels import bring_back, distance, renormalise, run_companion
from rubgen.solver.scheme.model import new_state
from rubgen.solver.scheme.motion_kernels import recover
from rubgen.solver.scheme.state_kernels import DIVERGED, OK, Snapshots
from rubgen.solver.speed.start import rub_free_stepper

STEPS, CLOSENESS = 96, 1e-7
WIDE = np.full(STEPS + 2, 0.1)
"""An opening of 0.1 m: nothing touches."""


@pytest.fixture
def stepper(small_system):
    return rub_free_stepper(small_system(), ContactLaw(), STEPS)


def beside(stepper, away):
    """A state whose first two motions are `away` (2, n) from those of the stepper."""
    state = new_state(stepper.model)
    for motion, main, step in zip(state.motions, stepper.state.motions, away, strict=False):
        motion.z[:] = main.z + stepper.blocks.to_z(step)
        recover(stepper.model.harmonics, motion, state.scratch.share)
    return state


def size(system, away, dt):
    """sqrt(d_v^T M d_v + Omega^2 d_q^T M d_q)."""
    d_v = (away[1] - away[0]) / dt
    return np.sqrt(d_v @ system.M @ d_v + system.speed**2 * away[1] @ system.M @ away[1])


def some_way(stepper, seed=1):
    return np.random.default_rng(seed).normal(size=(2, len(stepper.system.M))) * 1e-9


def test_a_number_comes_back_along_its_way_and_one_that_is_none_becomes_the_runs():
    main = np.array([1.0, -2.0, 3.0, np.nan, np.inf])
    companion = np.array([1.5, -2.0, np.nan, 4.0, 4.0])
    bring_back(main, 0.1, companion)
    np.testing.assert_allclose(companion, [1.05, -2.0, 3.0, np.nan, np.inf])


def test_the_distance_is_that_of_the_energy_norm(stepper):
    away = some_way(stepper)
    state = beside(stepper, away)
    main = np.stack([motion.z for motion in stepper.state.motions[:2]])
    found = distance(stepper.model.laws, stepper.model.energy.M, main, state.motions[:2], state.scratch)
    assert found == pytest.approx(size(stepper.system, away, stepper.dt), rel=1e-6)  # 1e-9 of 1e-3 is rounding of 1e-10


def test_a_renormalised_companion_is_close_in_the_direction_where_it_was(stepper):
    away, blades = some_way(stepper), stepper.system.n_blades
    state = beside(stepper, away)
    z = np.stack([motion.z for motion in stepper.state.motions[:2]])
    gaps, gap_way = np.linspace(1e-4, 2e-4, blades), np.linspace(-1e-8, 1e-8, blades)
    snapshots = Snapshots(np.array([STEPS]), z[None].copy(), np.stack([gaps, gaps])[None].copy())
    state.contact.step_gaps[:2] = gaps + gap_way
    before = size(stepper.system, away, stepper.dt)
    grown = renormalise(stepper.model, snapshots, 0, CLOSENESS, state.motions[:2], state)
    assert grown == pytest.approx(np.log(before / CLOSENESS), abs=1e-5)
    now = np.array([stepper.blocks.to_q(motion.z - main) for motion, main in zip(state.motions, z, strict=False)])
    np.testing.assert_allclose(now, away * CLOSENESS / before, atol=1e-5 * np.abs(now).max())
    np.testing.assert_allclose(state.contact.step_gaps[:2] - gaps, [gap_way * CLOSENESS / before] * 2, rtol=1e-5)
    tips = 3 * blades
    q = stepper.blocks.to_q(state.motions[1].z)
    np.testing.assert_allclose(state.motions[1].tips[:, :blades], q[:tips].reshape(-1, 3).T[:2], atol=1e-15)


def test_a_companion_that_is_the_run_has_no_growth(stepper):
    state = beside(stepper, np.zeros((2, len(stepper.system.M))))
    z = np.stack([motion.z for motion in stepper.state.motions[:2]])
    snapshots = Snapshots(np.array([STEPS]), z[None].copy(), np.zeros((1, 2, stepper.system.n_blades)))
    assert np.isnan(renormalise(stepper.model, snapshots, 0, CLOSENESS, state.motions[:2], state))


def test_without_contact_the_distance_grows_as_the_scheme_s_matrices_say(stepper):
    """A d_n+1 = (2 M / dt^2 - K) d_n - (M / dt^2 - C / (2 dt)) d_n-1, from snapshot to snapshot."""
    system, dt, ends = stepper.system, stepper.dt, [5, 37, 60, STEPS]
    stepper.take_snapshots(ends)
    away = some_way(stepper, 2)
    away *= CLOSENESS / size(system, away, dt)
    state, growth = beside(stepper, away), np.full(len(ends), np.nan)
    stepper.run_turn(WIDE)
    assert run_companion(stepper.model, WIDE, stepper.snapshots, CLOSENESS, state, growth) == OK
    A, back = system.M / dt**2 + system.C / (2 * dt), system.M / dt**2 - system.C / (2 * dt)
    sizes, (old, new) = [CLOSENESS], away
    for step in range(1, STEPS + 1):
        old, new = new, np.linalg.solve(A, (2 * system.M / dt**2 - system.K) @ new - back @ old)
        if step in ends:
            sizes.append(size(system, (old, new), dt))
    expected = np.diff(np.log(sizes))
    assert np.abs(expected).max() > 0.1
    np.testing.assert_allclose(growth, expected, atol=1e-4)


def test_a_companion_that_diverges_says_so(stepper):
    stepper.take_snapshots([STEPS])
    state = beside(stepper, np.full((2, len(stepper.system.M)), 1.0))
    stepper.run_turn(WIDE)
    growth = np.full(1, np.nan)
    assert run_companion(stepper.model, WIDE, stepper.snapshots, CLOSENESS, state, growth) == DIVERGED
    assert np.isnan(growth).all()
