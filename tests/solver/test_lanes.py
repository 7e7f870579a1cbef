"""The compiled sums over rows of eight against the same in plain Python."""

import numpy as np
import pytest

from rubgen.jit import kernel
from rubgen.solver.blocks import aligned
from rubgen.solver.lanes_kernels import (
    MOST_ROWS,
    add_lines,
    add_two_lines,
    dot_lines,
    dot_rows,
    line_kind,
)


def _both(a, b, x, y, lines, out, left):
    add_lines(lines, a, x, out)
    add_two_lines(lines, a, b, x, y, out)
    return dot_lines(lines, b, y, left) + dot_rows(left, left, 2)


both = kernel(_both)
KINDS = [(rows, scaled) for rows in range(1, MOST_ROWS + 1) for scaled in (False, True)]


@pytest.mark.parametrize("count", [0, 1, 2, 3, 4, 5, 11])
@pytest.mark.parametrize(("rows", "scaled"), KINDS)
def test_compiled_sums_are_those_of_plain_python(rows, scaled, count):
    """Counts below, at and beyond the partial sums; lines that read rows or numbers, mid-array, of one row and more."""
    rng = np.random.default_rng(count)
    a, b = (aligned(rng.normal(size=(80, 8))) for _ in range(2))
    x, y, left = (aligned(rng.normal(size=(20, 8))) for _ in range(3))
    lines = np.array([[0, 1, 2, 3, count], [line_kind(rows, scaled=scaled), 2, 13, 7, count]])
    results = []
    for function in (both, _both):
        out = aligned(np.ones((10, 8)))
        results.append((out, function(a, b, x, y, lines, out, left)))
    np.testing.assert_allclose(results[0][0], results[1][0], rtol=1e-13, atol=1e-13)
    assert results[0][1] == pytest.approx(results[1][1], rel=1e-13, abs=1e-13)
    expected, dot = np.ones((10, 8)), float((left[:2] ** 2).sum())
    for i in range(count):
        expected[1] += 2 * a[2 + i] * x[3 + i] + b[2 + i] * y[3 + i]
        dot += b[2 + i] * y[3 + i] @ left[1]
        from_x, from_y = (x.flat[7 + i], y.flat[7 + i]) if scaled else (x[7 + i], y[7 + i])
        for row in range(rows):
            entry = 13 + rows * i + row
            expected[2 + row] += 2 * a[entry] * from_x + b[entry] * from_y
            dot += b[entry] * from_y @ left[2 + row]
    np.testing.assert_allclose(results[0][0], expected, rtol=1e-13, atol=1e-13)
    assert results[0][1] == pytest.approx(dot, rel=1e-13, abs=1e-13)
