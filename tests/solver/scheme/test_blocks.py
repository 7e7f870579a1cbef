"""Blocks of matrices: found where blades are alike, one dense block where they are not, the same motion from both."""

import dataclasses

import numpy as np
import pytest

from rubgen.linalg import blocks as block_module
from rubgen.linalg.block_kernels import Product, multiply, quadratic
from rubgen.linalg.blocks import aligned, blade_harmonics, find_blocks
from rubgen.linalg.harmonic_kernels import recover_all
from rubgen.machine import load_machine
from rubgen.reduction import reduce
from rubgen.scenario import ContactLaw, Reduction
from rubgen.solver.linear.system_blocks import system_blocks
from rubgen.solver.scheme.central_difference import scheme
from rubgen.solver.scheme.free_step_kernels import free_step
from rubgen.solver.speed.start import rub_free_stepper
from rubgen.units import rad_per_s
from validation.reference_step import ReferenceStepper


def mistuned(system, spread=0.03):
    """The same with other spring stiffnesses at every blade; the springs' part of K alone is changed."""
    K, rng = system.K.copy(), np.random.default_rng(4)
    for k in range(system.n_blades):
        tip = slice(3 * k, 3 * k + 3)
        K[tip, tip] *= 1 + spread * rng.normal()
    return dataclasses.replace(system, K=K)


def sizes(system):
    blocks = system_blocks(system)
    found = [bundle.shape[1] for bundle in blocks.lanes for lane in bundle if lane[0] >= 0]
    return sorted(found + [len(block) for block in blocks.single], reverse=True)


@pytest.fixture(scope="module")
def preset():
    return reduce(load_machine("zeng2019"), Reduction()).at_speed(rad_per_s(6900.0))


def test_the_preset_falls_into_nodal_diameters(preset):
    """Two and two modes at nodal diameters 1 and 0; O_d x, y at 1; diameter 18 is one harmonic; the casing's modes."""
    assert sizes(preset) == [10] + [6] * 16 + [5, 3] + [1] * 11


def test_one_blade_that_differs_by_a_millionth_couples_all(preset):
    K = preset.K.copy()
    K[0, 0] *= 1 + 1e-6
    assert sizes(dataclasses.replace(preset, K=K)) == [114] + [1] * 11


@pytest.mark.parametrize("blades", [1, 2, 5, 6, 36])
def test_harmonics_are_orthonormal_and_turn_with_the_blades(blades):
    F = blade_harmonics(blades)
    np.testing.assert_allclose(F.T @ F, np.eye(blades), atol=1e-14)
    shift = F.T @ np.roll(F, 1, axis=0)
    coupled = np.abs(shift) > 1e-12
    assert coupled.sum() <= 2 * blades


@pytest.mark.parametrize("spread", [0.0, 0.03])
def test_products_are_those_of_the_dense_matrices(small_system, spread):
    system = mistuned(small_system(), spread)
    blocks, rng = system_blocks(system), np.random.default_rng(2)
    n = len(system.M)
    q, p = rng.normal(size=(2, n))
    np.testing.assert_allclose(blocks.to_q(blocks.to_z(q)), q, atol=1e-14)
    for matrix in (system.M, system.C, system.K):
        out = aligned(np.zeros(8 * blocks.rows))
        multiply(blocks.product(matrix), blocks.to_z(q), out)
        np.testing.assert_allclose(blocks.to_q(out), matrix @ q, atol=1e-9 * np.abs(matrix).max())
        found = quadratic(blocks.product(matrix), blocks.to_z(p), blocks.to_z(q))
        assert found == pytest.approx(p @ matrix @ q, rel=1e-9, abs=1e-9 * np.abs(matrix).max())
        triangle = quadratic(blocks.damping(matrix), blocks.to_z(q), blocks.to_z(q))
        assert 2 * triangle == pytest.approx(q @ matrix @ q, rel=1e-9)


@pytest.mark.parametrize("lobes", [2, 3])
def test_mistuned_blades_move_as_plain_numpy_says(small_system, lobes):
    system, steps = mistuned(small_system(lobes=lobes, speed=400.0)), 256
    assert max(sizes(system)) == 14  # all in the plane: twelve and O_d
    stepper = rub_free_stepper(system, ContactLaw(friction=0.1), steps)
    for turn in range(6):
        stepper.run_turn(np.full(steps + 2, 5e-4 * (1 - turn / 6)))
    reference, touched = ReferenceStepper(system, 0.1, steps), 0
    reference.before, reference.now = stepper.coordinates.before, stepper.coordinates.now
    for _ in range(5):
        stepper.set_coordinates(reference.before, reference.now)
        assert stepper.run_turn()[0] == 0
        touching = sum(reference.step(s) > 0 for s in range(steps))
        assert touching == stepper.result.summary[1]
        np.testing.assert_allclose(stepper.coordinates.now, reference.now, atol=1e-6 * np.abs(reference.now).max())
        touched += touching
    assert touched > 100


def test_blocks_and_one_dense_block_give_one_motion(small_system, monkeypatch):
    """Regular rub of a tuned row, in its blocks and with every coordinate taken as coupled to every other."""
    ends = []
    for dense in (False, True):
        if dense:
            monkeypatch.setattr(block_module, "coupled", lambda matrix: np.ones(matrix.shape, dtype=bool))
        system = small_system(speed=500.0)
        stepper = rub_free_stepper(system, ContactLaw(friction=0.1), 256)
        assert (len(stepper.blocks.single) == 1 and not stepper.blocks.lanes) is dense
        impulse = 0.0
        for turn in range(10):
            stepper.run_turn(np.full(258, 5e-4 * max(0, 1 - turn / 6)))
            impulse += stepper.result.summary[0]
        ends.append(np.concatenate([stepper.coordinates.now, stepper.result.taps[:2].ravel(), [impulse]]))
    assert ends[0][-1] > 1
    np.testing.assert_allclose(ends[1], ends[0], atol=1e-9)


def test_a_free_step_of_several_lanes_is_that_of_the_matrices():
    """Eleven blocks of three, more than a register holds, with all of M, C and K dense and unsymmetric in each."""
    rng, n = np.random.default_rng(6), 33
    order = rng.permutation(n)
    M, C, K = np.zeros((3, n, n))
    for part in order.reshape(11, 3):
        M[np.ix_(part, part)] = np.eye(3) + 0.1 * rng.normal(size=(3, 3))
        C[np.ix_(part, part)] = rng.normal(size=(3, 3))
        K[np.ix_(part, part)] = rng.normal(size=(3, 3))
    blocks = find_blocks([M, C, K], 0)
    assert [bundle.shape for bundle in blocks.lanes] == [(8, 3), (8, 3)]
    dt, (before, now, force) = 0.1, rng.normal(size=(3, n))
    after = blocks.to_z(now)
    free_step(scheme(M, C, K, force, dt, blocks), blocks.to_z(before), blocks.to_z(now), after)
    q = blocks.to_q(after)
    balance = M @ (q - 2 * now + before) / dt**2 + C @ (q - before) / (2 * dt) + K @ now - force
    np.testing.assert_allclose(balance, 0, atol=1e-10 * np.abs(M).max() / dt**2)


def check_recovery(system):
    stepper = rub_free_stepper(system, ContactLaw(), 1024)
    q = np.random.default_rng(1).normal(size=len(system.M))
    found, scratch = np.zeros(len(q)), stepper.state.scratch
    recover_all(stepper.model.harmonics, stepper.blocks.to_z(q), scratch.share, scratch.tips, found)
    np.testing.assert_allclose(found, q, atol=1e-14 * 36)


def test_tips_are_recovered_as_by_the_whole_transform(preset):
    check_recovery(preset)


@pytest.mark.parametrize("blades", [1, 2, 5, 6, 17, 18, 97])
def test_tips_of_any_number_of_blades_are_recovered(small_system, blades):
    """Odd numbers, which no half turn maps onto themselves, and more rows of eight than one line gives."""
    check_recovery(small_system(blades=blades))


def entries_used(product):
    kind, count = product.lines[:, 0], product.lines[:, 4]
    return int(((kind // 2 + 1) * count).sum())


def test_damping_leaves_out_what_only_coriolis_forces_couple(preset):
    """Of blocks of six, two sets of three: 16 rows of entries instead of 36, in every lane."""
    blocks = system_blocks(preset)
    parted, whole = blocks.damping(preset.C), blocks.damping(preset.C, whole=True)
    bundles = [bundle for bundle in blocks.lanes if bundle.shape[1] == 6]
    assert len(bundles) == 2
    assert entries_used(whole) - entries_used(parted) == 2 * (36 - 16)
    for q in np.random.default_rng(4).normal(size=(5, len(preset.M))):
        works = [2 * quadratic(product, blocks.to_z(q), blocks.to_z(q)) for product in (parted, whole)]
        assert works == pytest.approx([q @ preset.C @ q] * 2, rel=1e-9)


def test_a_dense_triangle_is_kept_whole(small_system, monkeypatch):
    system = small_system()
    blocks = system_blocks(system)
    monkeypatch.setattr(block_module, "coupled", lambda matrix: np.ones(matrix.shape, dtype=bool))
    parted, whole = blocks.damping(system.C), blocks.damping(system.C, whole=True)
    np.testing.assert_array_equal(parted.lines, whole.lines)
    np.testing.assert_array_equal(parted.entries, whole.entries)


def test_rounding_beside_the_stiffness_is_no_circulatory_force(preset):
    """Blades have none: of the preset, one block with O_d is left, to which the supports' dampers belong."""
    blocks = system_blocks(preset)
    skew = (preset.K - preset.K.T) / 2
    product = blocks.without_zeros(skew, preset.K)
    assert 0 < entries_used(product) <= 20
    q, p = np.random.default_rng(3).normal(size=(2, len(skew)))
    found = quadratic(product, blocks.to_z(p), blocks.to_z(q))
    assert found == pytest.approx(p @ skew @ q, rel=1e-9)


def test_lines_of_zeros_are_left_out(small_system):
    system = small_system()
    blocks = system_blocks(system)
    skew = (system.K - system.K.T) / 2
    product = blocks.without_zeros(skew, system.K)
    assert isinstance(product, Product)
    assert 0 < len(product.lines) < len(blocks.product(skew).lines)
    q, p = np.random.default_rng(3).normal(size=(2, len(skew)))
    assert quadratic(product, blocks.to_z(p), blocks.to_z(q)) == pytest.approx(p @ skew @ q)
