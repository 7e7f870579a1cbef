"""A skew-symmetric matrix of low rank as pairs of vectors."""

import numpy as np
import pytest

from rubgen.jit import kernel
from rubgen.linalg.blocks import find_blocks
from rubgen.linalg.lanes_kernels import dot_pairs


def _dot(pairs, left, right):
    return dot_pairs(pairs, left, right)


dot = kernel(_dot)
SIZE = 45


def stiffness():
    """One block of 45: a dense symmetric matrix."""
    K = np.random.default_rng(1).normal(size=(SIZE, SIZE))
    return K + K.T


def skew_of_rank(rank):
    """A skew-symmetric matrix (45, 45), its pairs of sizes 1, 1e-3, 1e-6 and so on."""
    rng, matrix = np.random.default_rng(2), np.zeros((SIZE, SIZE))
    for pair in range(rank // 2):
        a, b = rng.normal(size=(2, SIZE))
        matrix += 10.0 ** (-3 * pair) * (np.outer(a, b) - np.outer(b, a))
    return matrix


@pytest.mark.parametrize("rank", [0, 2, 4, 6])
def test_a_skew_matrix_of_low_rank_is_a_sum_of_pairs(rank):
    """Its bilinear form from pairs of vectors, compiled and in plain Python, against the dense product."""
    K, matrix = stiffness(), skew_of_rank(rank)
    blocks = find_blocks([K], 0)
    pairs = blocks.skew_pairs(matrix, K, most=3)
    assert pairs.shape == (rank // 2, 2, 48)
    for p, q in np.random.default_rng(3).normal(size=(5, 2, SIZE)):
        tolerance = 1e-12 * (np.abs(p) @ np.abs(matrix) @ np.abs(q))
        for function in (dot, _dot):
            found = function(pairs, blocks.to_z(p), blocks.to_z(q))
            assert found == pytest.approx(p @ matrix @ q, rel=0, abs=tolerance)


def test_a_skew_matrix_of_higher_rank_has_no_pairs():
    K = stiffness()
    assert find_blocks([K], 0).skew_pairs(skew_of_rank(6), K, most=2) is None


def test_rounding_beside_another_matrix_makes_no_pair():
    K, matrix = stiffness(), skew_of_rank(4)
    noise = np.random.default_rng(4).normal(size=(SIZE, SIZE))
    blocks = find_blocks([K], 0)
    assert len(blocks.skew_pairs(matrix + 1e-16 * (noise - noise.T), K, most=3)) == 2
    assert len(blocks.skew_pairs(matrix + 1e-12 * (noise - noise.T), K, most=SIZE)) > 2
