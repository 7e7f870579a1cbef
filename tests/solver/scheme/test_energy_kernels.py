"""Stored energy and works of the linear forces, against dense matrices; works of contacts: test_contact_rows.py."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.linalg.blocks import aligned
from rubgen.linalg.lanes_kernels import TOGETHER
from rubgen.machine import load_machine
from rubgen.reduction import reduce
from rubgen.scenario import ContactLaw, Reduction
from rubgen.solver.linear.system_blocks import system_blocks
from rubgen.solver.scheme.central_difference import energy_terms
from rubgen.solver.scheme.energy_kernels import (
    ABSOLUTE,
    CIRCULATORY,
    DAMPING,
    UNBALANCE,
    WORKS,
    add_linear_works,
    add_waiting_works,
    book_linear_works,
    stored_energy,
)
from rubgen.solver.scheme.state_kernels import Waiting
from rubgen.solver.speed.start import rub_free_stepper
from rubgen.units import rad_per_s


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


@pytest.fixture(scope="module")
def preset():
    return reduce(load_machine("zeng2019"), Reduction()).at_speed(rad_per_s(6900.0))


def uneven(system):
    """The same system with one stiffer blade."""
    K = system.K.copy()
    K[1, 1] *= 1.02
    return replace(system, K=K)


@pytest.mark.parametrize("zeros", [False, True])
def test_works_of_an_uneven_blade_are_those_of_the_dense_matrices(preset, zeros):
    """Two pairs of vectors stand for the circulatory stiffness, except where all entries must remain."""
    system, dt = uneven(preset), 2e-5
    blocks = system_blocks(system)
    terms = energy_terms(system, blocks, zeros=zeros)
    assert len(terms.circulatory_pairs) == (0 if zeros else 2)
    assert (len(terms.circulatory.lines) > 0) is zeros
    now, change = np.random.default_rng(5).normal(size=(2, len(system.M))) * 1e-4
    works, skew = np.zeros(WORKS), (system.K - system.K.T) / 2
    add_linear_works(terms, blocks.to_z(now), blocks.to_z(change), dt, works)
    summed = np.abs(change) @ np.abs(skew) @ np.abs(now)
    assert works[CIRCULATORY] == pytest.approx(-change @ skew @ now, rel=0, abs=1e-12 * summed)
    assert works[DAMPING] == pytest.approx(-change @ system.C @ change / dt, rel=1e-9)


@pytest.mark.parametrize("zeros", [False, True])
@pytest.mark.parametrize("steps", [0, 3, 4, 11])
def test_works_that_wait_are_those_of_each_step(preset, steps, zeros):
    """Pairs and a dense product; numbers of steps below, at and beyond those taken at once."""
    system, dt = uneven(preset), 2e-5
    blocks = system_blocks(system)
    terms = energy_terms(system, blocks, zeros=zeros)
    assert terms.waits
    size = 8 * blocks.rows
    waiting, count = Waiting(*np.full((2, TOGETHER, size), np.nan), *np.full((2, TOGETHER), np.nan)), 0
    works, expected, rng = np.zeros(WORKS), np.zeros(WORKS), np.random.default_rng(6)
    for step in range(steps):
        now, change = (blocks.to_z(each) for each in rng.normal(size=(2, len(system.M))) * 1e-4)
        count = book_linear_works(terms, now, change, dt, count, waiting, works)
        assert count == (step + 1) % TOGETHER
        add_linear_works(terms, now, change, dt, expected)
    add_waiting_works(terms, count, dt, waiting, works)
    assert (expected[[UNBALANCE, DAMPING, CIRCULATORY, ABSOLUTE]] != 0).all() == (steps > 0)
    np.testing.assert_allclose(works, expected, rtol=0, atol=1e-13 * expected[ABSOLUTE])


def test_works_of_equal_blades_do_not_wait(preset):
    assert not energy_terms(preset, system_blocks(preset)).waits


def test_equal_blades_keep_the_product_of_the_circulatory_stiffness(preset):
    blocks = system_blocks(preset)
    terms = energy_terms(preset, blocks)
    product = blocks.without_zeros((preset.K - preset.K.T) / 2, preset.K)
    assert len(terms.circulatory_pairs) == 0
    np.testing.assert_array_equal(terms.circulatory.lines, product.lines)
    np.testing.assert_array_equal(terms.circulatory.entries, product.entries)
