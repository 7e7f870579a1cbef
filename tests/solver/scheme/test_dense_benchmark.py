"""The dense numba step that the benchmark times takes the reference's step, and the timing leaves the states alone."""

import numpy as np
import pytest

from rubgen import make_scenario
from rubgen.reduction import reduce
from rubgen.scenario import Reduction
from validation.reference_step import ReferenceStepper

STEPS = 256


@pytest.fixture(scope="module")
def reference():
    """A preset whose tips are pushed into the casing, so that most steps have contact."""
    scenario = make_scenario("zeng2019", speed_rpm=10000.0, clearance_m=1e-5)
    system = reduce(scenario.machine, Reduction()).at_speed(scenario.operation.speed_rad_per_s)
    reference = ReferenceStepper(system, 0.1, STEPS)
    q = np.zeros(len(system.M))
    q[0 : 3 * system.n_blades : 9] = 6e-4
    reference.set_state(q, q)
    return reference


@pytest.mark.parametrize("screening", [True, False])
def test_dense_step_is_the_reference_step(reference, screening):
    from benchmarks.bench_dense import dense_of
    from benchmarks.dense_kernels import dense_step

    n = len(reference.now)
    before, now = reference.before.copy(), reference.now.copy()
    dense, q, after, touched = dense_of(reference, screening=screening), np.concatenate([now, before]), np.zeros(n), 0
    for index in range(12):
        own = dense_step(dense, 2 * np.pi * (index + 1) / STEPS, q, after)
        assert own == reference.step(index)
        touched += own
        q[n:], q[:n] = q[:n].copy(), after
        np.testing.assert_allclose(after, reference.now, rtol=0, atol=1e-9 * np.abs(reference.now).max())
    assert touched > 12
    reference.set_state(before, now)


def test_timed_turn_of_the_reference_starts_and_ends_in_the_same_state(reference):
    from benchmarks.bench_solver import turn_time

    before, now = reference.before.copy(), reference.now.copy()
    assert turn_time(reference) > 0
    np.testing.assert_array_equal(reference.before, before)
    np.testing.assert_array_equal(reference.now, now)
