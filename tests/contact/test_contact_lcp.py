from itertools import combinations

import numpy as np
import pytest

from rubgen.contact.lcp_kernels import RIGID, SOLVED, UNSOLVED, is_positive_definite, lemke, projected_gauss_seidel
from tests.contact_calls import solve_complementarity


def by_enumeration(W, b):
    """All solutions of the complementarity problem by trying every active set."""
    m, solutions = len(b), []
    for size in range(m + 1):
        for active in combinations(range(m), size):
            lam, index = np.zeros(m), list(active)
            if index:
                lam[index] = np.linalg.solve(W[np.ix_(index, index)], -b[index])
            if np.all(lam >= 0) and np.all((b + W @ lam)[[i for i in range(m) if i not in index]] >= 0):
                solutions.append(lam)
    return solutions


def unsymmetric_positive_definite(rng, m):
    root = rng.normal(size=(m, m))
    skew = rng.normal(size=(m, m))
    return root @ root.T / m + 0.5 * np.eye(m) + 0.3 * (skew - skew.T)


def test_unsymmetric_problems_have_the_one_solution_of_enumeration():
    rng = np.random.default_rng(7)
    for m in (1, 2, 3, 5, 7):
        for _ in range(20):
            W, b = 1e-9 * unsymmetric_positive_definite(rng, m), 1e-6 * rng.normal(size=m)
            (expected,) = by_enumeration(W, b)
            np.testing.assert_allclose(solve_complementarity(W, b), expected, atol=1e-10 * max(expected.max(), 1))


def test_gauss_seidel_and_lemke_agree():
    rng = np.random.default_rng(8)
    for m in (2, 6, 12):
        W, b = unsymmetric_positive_definite(rng, m), rng.normal(size=m)
        pivoted, swept = np.zeros(m), np.zeros(m)
        assert lemke(W, b, m, pivoted, np.zeros((m, 2 * m + 2)), np.zeros(m, dtype=np.int64)) == SOLVED
        if projected_gauss_seidel(np.array([RIGID]), W, b, b, m, swept) == SOLVED:
            np.testing.assert_allclose(swept, pivoted, atol=1e-11)


def test_the_guard_sees_an_indefinite_symmetric_part():
    work = np.zeros((2, 2))
    assert is_positive_definite(np.array([[1.0, 5.0], [-5.0, 1.0]]), 2, work)
    assert not is_positive_definite(np.array([[1.0, 5.0], [5.0, 1.0]]), 2, work)
    assert not is_positive_definite(np.array([[-1.0]]), 1, work)
    assert not is_positive_definite(np.array([[np.nan]]), 1, work)


def test_an_indefinite_but_solvable_problem_is_pivoted():
    W, b = np.array([[1.0, 3.0], [3.0, 1.0]]), np.array([-1.0, -1.0])
    lam = solve_complementarity(W, b)
    assert any(np.allclose(lam, solution) for solution in by_enumeration(W, b))


def test_degenerate_problems_that_have_a_solution_are_solved():
    """Semi-definite W of small whole numbers: the ratio test has ties, where another row than z0's ends on a ray."""
    rng = np.random.default_rng(9)
    for m in (2, 3, 4) * 100:
        root, pressed = rng.integers(-2, 3, (m, m)).astype(float), rng.integers(0, 2, m)
        W = root @ root.T
        if not W.any():
            continue
        b = (1 - pressed) * rng.integers(0, 2, m) - W @ (pressed * rng.integers(0, 2, m))
        lam = np.zeros(m)
        assert lemke(W, b, m, lam, np.zeros((m, 2 * m + 2)), np.zeros(m, dtype=np.int64)) == SOLVED
        gap = b + W @ lam
        assert min(lam.min(), gap.min()) > -1e-10
        assert abs(lam @ gap) < 1e-9


def test_a_problem_without_solution_is_refused():
    W, b = np.array([[-1.0]]), np.array([-1.0])
    assert lemke(W, b, 1, np.zeros(1), np.zeros((1, 4)), np.zeros(1, dtype=np.int64)) == UNSOLVED
    with pytest.raises(ArithmeticError, match="1 contacts"):
        solve_complementarity(W, b)
