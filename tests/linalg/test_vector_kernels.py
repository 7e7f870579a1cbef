"""Functions for vector registers against the same in plain Python."""

import numpy as np
import pytest

from rubgen.jit import kernel
from rubgen.linalg.vector_kernels import blended_product, lowest_bit, not_above, square_of_farthest


def _blend(a, first, second, share, x):
    return blended_product(a, first, second, share, x)


def _near(x, row, limit):
    return not_above(x, row, limit)


def _lowest(bits):
    return lowest_bit(bits)


def _farthest(a, b):
    return square_of_farthest(a, b)


blend, near, lowest, farthest = (kernel(function) for function in (_blend, _near, _lowest, _farthest))


@pytest.mark.parametrize("width", [8, 16, 40])
def test_a_product_with_a_line_between_two(width):
    rng = np.random.default_rng(width)
    a, x = rng.normal(size=(7, width)), rng.normal(size=width)
    for first, second, share in ((2, 5, 0.3), (6, 0, 0.0), (0, 1, 1.0)):
        expected = (1 - share) * (a[first] @ x) + share * (a[second] @ x)
        for function in (blend, _blend):
            assert function(a, first, second, share, x) == pytest.approx(expected, rel=1e-13, abs=1e-13)


def test_the_numbers_that_are_not_above_a_limit_one_by_one():
    x = np.array([0.0] * 8 + [1.0, -2.0, 3.0, np.inf, np.nan, -np.inf, 2.0, 2.0 + 1e-12] + [9.0] * 8)
    for function in (near, _near):
        assert function(x, 1, 2.0) == 0b01110011
        assert function(x, 0, -1e-300) == 0
        assert function(x, 0, 0.0) == 0b11111111
        assert function(x, 2, np.inf) == 0b11111111


def test_bits_are_taken_one_after_the_other():
    for function in (lowest, _lowest):
        assert [function(1 << i) for i in range(8)] == list(range(8))
        assert function(0b10110000) == 4


def test_the_farthest_of_many_points():
    rng = np.random.default_rng(1)
    for place in range(16):
        a, b = rng.normal(size=(2, 3, 16))
        a[:2, place] = b[:2, place] + [30.0, -40.0]
        for function in (farthest, _farthest):
            assert function(a, b) == pytest.approx(2500.0, rel=1e-13)
            assert function(a, a) == 0.0


def test_a_column_that_is_no_number_is_left_out_of_the_farthest():
    a, b = np.zeros((2, 16)), np.zeros((2, 16))
    a[:, 3], a[:, 12] = [3.0, 4.0], [1.0, 0.0]
    for place in range(16):
        broken = a.copy()
        broken[place % 2, place] = np.nan
        for function in (farthest, _farthest):
            assert function(broken, b) == (1.0 if place == 3 else 25.0)
            assert function(np.full((2, 16), np.nan), b) == 0.0
    a[0, 5] = np.inf
    assert [function(a, b) for function in (farthest, _farthest)] == [np.inf, np.inf]
