"""Stored energy and works of the linear forces, against dense matrices; works of contacts: test_contact_rows.py."""

import numpy as np
import pytest

from rubgen.linalg.blocks import aligned
from rubgen.scenario import ContactLaw
from rubgen.solver.scheme.energy_kernels import (
    ABSOLUTE,
    CIRCULATORY,
    DAMPING,
    UNBALANCE,
    WORKS,
    add_linear_works,
    stored_energy,
)
from rubgen.solver.speed.start import rub_free_stepper


@pytest.fixture
def stepper(small_system):
    return rub_free_stepper(small_system(), ContactLaw(), 96)


def states(stepper, seed):
    """Coordinates (3, n) at three steps."""
    return np.random.default_rng(seed).normal(size=(3, len(stepper.system.M))) * 1e-4


def test_the_stored_energy_is_kinetic_and_strain_energy_between_two_steps(stepper):
    system, dt, to_z = stepper.system, stepper.dt, stepper.blocks.to_z
    before, now, _ = states(stepper, 1)
    v = (now - before) / dt
    expected = 0.5 * (v @ system.M @ v + now @ (system.K + system.K.T) / 2 @ before)
    found = stored_energy(stepper.model.energy, to_z(before), to_z(now), to_z(now - before), dt)
    assert found == pytest.approx(expected, rel=1e-10)


def test_works_of_unbalance_dampers_and_circulatory_forces(stepper):
    system, dt, to_z = stepper.system, stepper.dt, stepper.blocks.to_z
    before, now, after = states(stepper, 2)
    change = (after - before) / 2
    works = np.zeros(WORKS)
    for _ in range(2):
        add_linear_works(stepper.model.energy, to_z(now), aligned(to_z(change)), dt, works)
    expected = np.zeros(WORKS)
    expected[UNBALANCE] = system.force @ change
    expected[DAMPING] = -change @ system.C @ change / dt
    expected[CIRCULATORY] = -change @ (system.K - system.K.T) / 2 @ now
    expected[ABSOLUTE] = np.abs(expected).sum()
    assert np.all(expected[[UNBALANCE, DAMPING, CIRCULATORY]] != 0)
    assert works[DAMPING] < 0
    np.testing.assert_allclose(works, 2 * expected, rtol=1e-9, atol=1e-15)
