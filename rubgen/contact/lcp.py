"""The complementarity problem of one contact step."""

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.contact.lcp_kernels import SOLVED, solve_lcp


class LcpUnsolvedError(ArithmeticError):
    """No solution of a linear complementarity problem was found."""


def solve_complementarity(W: FloatArray, b: FloatArray) -> FloatArray:
    """Lam (m,) with 0 <= lam _|_ b + W lam >= 0.

    `W` (m, m) need not be symmetric. Where its symmetric part is positive definite (friction up to about 0.3) the
    solution is unique. Projected Gauss-Seidel finds it to 1e-14 of the largest multiplier. In all other cases Lemke's
    pivoting is used. Raises LcpUnsolvedError where both fail.
    """
    m = b.shape[0]
    lam = np.zeros(m)
    work = np.zeros((m, m)), np.zeros((m, 2 * m + 2)), np.zeros(m, dtype=np.int64)
    if solve_lcp(np.ascontiguousarray(W), np.ascontiguousarray(b), m, lam, *work) != SOLVED:
        raise LcpUnsolvedError(f"no contact forces found for {m} contacts")
    return lam
