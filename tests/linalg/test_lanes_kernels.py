"""The compiled sums over rows of eight against the same in plain Python."""

import numpy as np
import pytest

from rubgen.jit import kernel
from rubgen.linalg.blocks import aligned
from rubgen.linalg.lanes_kernels import (
    MOST_ROWS,
    TOGETHER,
    add_lines,
    dot_lines,
    dot_lines_each,
    dot_rows,
    gather_lines,
    line_kind,
    set_two_lines,
)


def _both(a, b, x, y, lines, base, out, left):
    set_two_lines(lines, a, b, x, y, base, out)
    add_lines(lines, a, x, out)
    return dot_lines(lines, b, y, left) + dot_rows(left, left, 2)


def _gather(lines, a, z, places, out):
    gather_lines(lines, a, z, places, 2, 0, out)


def _dot_each(lines, a, x, left, out):
    dot_lines_each(lines, a, x, left, out)


both, gather, dot_each = kernel(_both), kernel(_gather), kernel(_dot_each)
LINE_KINDS = [(rows, scaled) for rows in range(1, MOST_ROWS + 1) for scaled in (False, True)]


@pytest.mark.parametrize("count", [0, 1, 2, 3, 4, 5, 11])
@pytest.mark.parametrize(("rows", "scaled"), LINE_KINDS)
def test_compiled_sums_are_those_of_plain_python(rows, scaled, count):
    """Counts below, at and beyond the partial sums; lines that read rows or numbers, mid-array, of one row and more."""
    rng = np.random.default_rng(count)
    a, b = (aligned(rng.normal(size=(80, 8))) for _ in range(2))
    x, y, left, base = (aligned(rng.normal(size=(20, 8))) for _ in range(4))
    lines = np.array([[0, 1, 2, 3, count], [line_kind(rows, scaled=scaled), 2, 13, 7, count]])
    results = []
    for function in (both, _both):
        out = aligned(np.ones((10, 8)))
        results.append((out, function(a, b, x, y, lines, base, out, left)))
    np.testing.assert_allclose(results[0][0], results[1][0], rtol=1e-13, atol=1e-13)
    assert results[0][1] == pytest.approx(results[1][1], rel=1e-13, abs=1e-13)
    expected, dot = np.ones((10, 8)), float((left[:2] ** 2).sum())
    expected[1 : 2 + rows] = base[1 : 2 + rows]
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


@pytest.mark.parametrize("count", [0, 1, 5])
@pytest.mark.parametrize("rows", range(1, MOST_ROWS + 1))
def test_compiled_gathered_sums_are_those_of_plain_python(rows, count):
    """Two of three coordinates, in turned order; the third one's results stay."""
    rng = np.random.default_rng(count)
    a, z = aligned(rng.normal(size=(40, 8))), aligned(rng.normal(size=50))
    places = rng.integers(0, 50, size=(3, 16))
    lines = np.array([[line_kind(1, scaled=True), 0, 2, 1, count], [line_kind(rows, scaled=True), 1, 9, 4, count]])
    results = [aligned(np.full((3, 8 * (1 + MOST_ROWS)), 7.0)) for _ in range(2)]
    for function, out in zip((gather, _gather), results, strict=True):
        function(lines, a, z, places, out)
    np.testing.assert_allclose(results[0], results[1], rtol=1e-13, atol=1e-13)
    for c in (0, 2):
        first = sum((a[2 + i] * z[places[c, 1 + i]] for i in range(count)), np.zeros(8))
        last = sum((a[9 + rows * i + rows - 1] * z[places[c, 4 + i]] for i in range(count)), np.zeros(8))
        np.testing.assert_allclose(results[0][c, :8], first, rtol=1e-13, atol=1e-13)
        np.testing.assert_allclose(results[0][c, 8 * rows : 8 * rows + 8], last, rtol=1e-13, atol=1e-13)
    assert np.all(results[0][1] == 7.0)
    assert np.all(results[0][:, 8 * (1 + rows) :] == 7.0)


@pytest.mark.parametrize("count", [0, 1, 5])
@pytest.mark.parametrize(("rows", "scaled"), LINE_KINDS)
def test_several_vectors_have_the_sums_of_each(rows, scaled, count):
    """Compiled and in plain Python, against the dense products; another line follows."""
    rng = np.random.default_rng(count)
    a = aligned(rng.normal(size=(60, 8)))
    x, left = (aligned(rng.normal(size=(TOGETHER, 12 * 8))) for _ in range(2))
    lines = np.array([[line_kind(rows, scaled=scaled), 2, 3, 5, count], [line_kind(1, scaled=False), 1, 40, 0, 3]])
    expected = np.zeros(TOGETHER)
    for v in range(TOGETHER):
        X, L = x[v].reshape(-1, 8), left[v].reshape(-1, 8)
        for i in range(count):
            factor = x[v, 5 + i] if scaled else X[5 + i]
            expected[v] += sum((a[3 + rows * i + row] * factor) @ L[2 + row] for row in range(rows))
        expected[v] += sum((a[40 + i] * X[i]) @ L[1] for i in range(3))
    for function in (dot_each, _dot_each):
        out = np.full(TOGETHER, np.nan)
        function(lines, a, x, left, out)
        np.testing.assert_allclose(out, expected, rtol=1e-13, atol=1e-12)
