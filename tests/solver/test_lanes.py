"""The compiled sums over rows of eight against the same in plain Python."""

import numpy as np
import pytest

from rubgen.jit import kernel
from rubgen.solver.blocks import aligned
from rubgen.solver.lanes_kernels import add_lines, add_two_lines, dot_lines, dot_rows


def _both(a, b, x, y, lines, out, left):
    add_lines(lines, a, x, out)
    add_two_lines(lines, a, b, x, y, out)
    return dot_lines(lines, b, y, left) + dot_rows(left, left, 2)


@pytest.mark.parametrize("count", [0, 1, 2, 3, 4, 5, 11])
def test_compiled_sums_are_those_of_plain_python(count):
    """Counts below, at and beyond the partial sums; a line that reads rows, and one that reads numbers, mid-array."""
    rng = np.random.default_rng(count)
    a, b = (aligned(rng.normal(size=(24, 8))) for _ in range(2))
    x, y, left = (aligned(rng.normal(size=(20, 8))) for _ in range(3))
    lines = np.array([[0, 1, 2, 3, count], [1, 0, 5, 17, count], [1, 1, 13, 2, count]])
    results = []
    for function in (kernel(_both), _both):
        out = aligned(np.ones((3, 8)))
        results.append((out, function(a, b, x, y, lines, out, left)))
    np.testing.assert_allclose(results[0][0], results[1][0], rtol=1e-13, atol=1e-13)
    assert results[0][1] == pytest.approx(results[1][1], rel=1e-13, abs=1e-13)
    expected = np.ones((3, 8))
    for i in range(count):
        expected[1] += 2 * a[2 + i] * x[3 + i] + b[2 + i] * y[3 + i]
        expected[0] += 2 * a[5 + i] * x.flat[17 + i] + b[5 + i] * y.flat[17 + i]
        expected[1] += 2 * a[13 + i] * x.flat[2 + i] + b[13 + i] * y.flat[2 + i]
    np.testing.assert_allclose(results[0][0], expected, rtol=1e-13, atol=1e-13)
