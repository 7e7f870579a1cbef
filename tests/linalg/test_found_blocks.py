"""Blocks found in made matrices: they are those that were put in, and products in them are the dense ones."""

from itertools import pairwise

import numpy as np
import pytest

from rubgen.jit import kernel
from rubgen.linalg.block_kernels import bilinear, multiply, quadratic
from rubgen.linalg.blocks import (
    aligned,
    blade_harmonics,
    coupled,
    find_blocks,
    padded,
    parts_of,
    scale_of,
    share_width,
    system_harmonics,
)
from rubgen.linalg.harmonic_kernels import recover_rest, recover_tips, spread_tip_force
from rubgen.linalg.lanes_kernels import MOST_ROWS

SIZES = {
    "single coordinates": [1] * 11,
    "one dense block": [45],
    "eight of a kind": [4] * 8,
    "nine of a kind": [3] * 9,
    "few large ones": [20, 20, 13],
    "all kinds": [17, 6, 6, 6, 5, 3, 3, 1, 1],
}


def in_blocks(sizes, rng):
    """A dense unsymmetric matrix in each of the blocks, and their coordinates, in random order."""
    n = sum(sizes)
    parts = np.split(rng.permutation(n), np.cumsum(sizes)[:-1])
    matrix = np.zeros((n, n))
    for part in parts:
        matrix[np.ix_(part, part)] = rng.normal(size=(len(part), len(part)))
    return matrix, [np.sort(part) for part in parts]


def found_in(blocks):
    lanes = [lane for bundle in blocks.lanes for lane in bundle if lane[0] >= 0]
    return sorted(tuple(part.tolist()) for part in (*lanes, *blocks.single))


@pytest.mark.parametrize("kind", SIZES)
def test_the_blocks_are_those_that_were_put_in(kind):
    matrix, parts = in_blocks(SIZES[kind], np.random.default_rng(1))
    blocks = find_blocks([matrix], 0)
    assert found_in(blocks) == sorted(tuple(part.tolist()) for part in parts)
    assert np.unique(blocks.place).size == len(matrix)
    assert blocks.place.max() < 8 * blocks.rows
    for part in parts:
        np.testing.assert_array_equal(blocks.connected(part[:1]), part)
    np.testing.assert_array_equal(blocks.connected(np.array([p[-1] for p in parts])), np.arange(len(matrix)))


@pytest.mark.parametrize("kind", SIZES)
def test_products_in_blocks_are_dense_products(kind):
    """Sums of several rows of results, of lanes without a block, and the triangle of dampers."""
    rng = np.random.default_rng(2)
    matrix, _ = in_blocks(SIZES[kind], rng)
    blocks = find_blocks([matrix], 0)
    q, p = rng.normal(size=(2, len(matrix)))
    z = blocks.to_z(q)
    assert np.count_nonzero(z) == len(q)
    out = aligned(np.ones(8 * blocks.rows))
    multiply(blocks.product(matrix), z, out)
    np.testing.assert_allclose(blocks.to_q(out - 1), matrix @ q, rtol=0, atol=1e-12)
    for product in (blocks.product(matrix), blocks.without_zeros(matrix, matrix)):
        for function in (quadratic, bilinear):
            assert function(product, blocks.to_z(p), z) == pytest.approx(p @ matrix @ q, rel=0, abs=1e-11)
    for whole in (False, True):
        triangle = blocks.damping(matrix, whole=whole)
        assert 2 * quadratic(triangle, z, z) == pytest.approx(q @ matrix @ q, rel=0, abs=1e-11)


def test_one_matrix_that_couples_is_enough():
    first, second = np.diag([1.0, 2.0, 3.0, 4.0]), np.eye(4)
    second[0, 3] = 1e-6  # above the tolerance, and from one side only
    assert found_in(find_blocks([first], 0)) == [(0,), (1,), (2,), (3,)]
    assert found_in(find_blocks([first, second], 0)) == [(0, 3), (1,), (2,)]


def test_an_entry_is_small_beside_its_own_row_and_column():
    """sqrt(m_i m_j): soft coordinates couple by entries that would be rounding beside the stiff ones."""
    matrix = np.diag([1e9, 1e9, 1.0, 1.0])
    matrix[0, 1] = 1e-1
    matrix[2, 3] = 1e-1
    matrix[0, 2] = 1e-5
    np.testing.assert_allclose(scale_of(matrix)[0], [1e9, 1e9, 1e9**0.5, 1e9**0.5], rtol=1e-12)
    off = coupled(matrix) & ~np.eye(4, dtype=bool)
    assert np.argwhere(off).tolist() == [[2, 3]]


def test_parts_are_nearly_equal_and_none_is_too_large():
    for rows in range(1, 60):
        parts = parts_of(rows)
        sizes = [part.stop - part.start for part in parts]
        assert [parts[0].start, parts[-1].stop, sum(sizes)] == [0, rows, rows]
        assert all(before.stop == after.start for before, after in pairwise(parts))
        assert max(sizes) <= MOST_ROWS
        assert max(sizes) - min(sizes) <= 1
        assert len(parts) == -(-rows // MOST_ROWS)


def test_rows_of_eight_begin_at_a_cache_line():
    for shape in ((5,), (3, 8), (1, 8), (2, 3, 8)):
        array = np.random.default_rng(3).normal(size=shape)
        copy = aligned(array)
        np.testing.assert_array_equal(copy, array)
        assert copy.ctypes.data % 64 == 0
        assert not np.shares_memory(copy, array)
    assert [padded(size) for size in (0, 1, 8, 9, 36)] == [0, 8, 8, 16, 40]


def _recover(harmonics, z, share, tips):
    recover_tips(harmonics, z, share, tips)


def _spread(harmonics, blade, force, scale, z_force):
    spread_tip_force(harmonics, blade, force, scale, z_force)


def _rest(harmonics, z, q):
    recover_rest(harmonics, z, q)


recover, spread, rest = kernel(_recover), kernel(_spread), kernel(_rest)


def bladed(blades):
    """A system of equal blades on a ring, every tip coordinate coupled to the same of its neighbours, and a centre."""
    n = 3 * blades + 2
    K = 5 * np.eye(n)
    for k in range(blades):
        for a in range(3):
            K[3 * k + a, 3 * ((k + 1) % blades) + a] += 1
            K[3 * ((k + 1) % blades) + a, 3 * k + a] += 1
    blocks = find_blocks([K], blades)
    return blocks, system_harmonics(blocks, blades)


@pytest.mark.parametrize("blades", [1, 3, 4, 10])
def test_a_force_on_a_tip_does_the_work_of_its_displacement(blades):
    """Virtual work: z_force . z = scale force . tip, for every blade; two rows of tips leave the axial ones alone."""
    rng = np.random.default_rng(blades)
    blocks, harmonics = bladed(blades)
    q = rng.normal(size=3 * blades + 2)
    z, share = blocks.to_z(q), np.zeros((3, share_width(blades)))
    tips = np.full((3, padded(blades)), 7.0)
    recover(harmonics, z, share, tips)
    np.testing.assert_allclose(tips[:, :blades].T.ravel(), q[:-2], atol=1e-13)
    assert (tips[:, blades:] == 7.0).all()
    plane = np.full((2, padded(blades)), 7.0)
    recover(harmonics, z, share, plane)
    np.testing.assert_array_equal(plane, tips[:2])
    last = np.zeros(q.size)
    rest(harmonics, z, last)
    np.testing.assert_array_equal(last, [0.0] * (3 * blades) + q[-2:].tolist())
    for blade in range(blades):
        force, z_force = rng.normal(size=3), np.zeros(z.size)
        spread(harmonics, blade, force, 2.5, z_force)
        assert z_force @ z == pytest.approx(2.5 * force @ q[3 * blade : 3 * blade + 3], rel=1e-12)
        np.testing.assert_allclose(blocks.to_q(z_force)[3 * blade : 3 * blade + 3], 2.5 * force, atol=1e-13)


@pytest.mark.parametrize("blades", [3, 4, 7, 12])
def test_equal_blades_couple_within_one_nodal_diameter(blades):
    """A circulant ring: its harmonics are eigenvectors, 5 + 2 cos(2 pi d / blades) of the diameter d."""
    blocks, _ = bladed(blades)
    assert max(len(part) for part in found_in(blocks)) == 1
    ring = 5 * np.eye(blades) + np.roll(np.eye(blades), 1, axis=0) + np.roll(np.eye(blades), -1, axis=0)
    F = blade_harmonics(blades)
    diameter = (np.arange(blades) + 1) // 2
    expected = 5 + 2 * np.cos(2 * np.pi * diameter / blades)
    np.testing.assert_allclose(F.T @ ring @ F, np.diag(expected), atol=1e-13)
