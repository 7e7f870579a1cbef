"""Solve for the normal forces of one step. For rigid contact it is the problem 0 <= lam _|_ b + W lam >= 0."""

import math

from rubgen.arrays import FloatArray, IntArray
from rubgen.jit import allocation_free_kernel, switch
from rubgen.scenario.contact_laws.contact_law import NORMAL_LAWS

SOLVED = 0
UNSOLVED = 1
SWEEPS = 400
TOLERANCE = 1e-14
RIGID = 0.0
"""The number of rigid contact in the registry."""
respond = switch([law.respond for law in NORMAL_LAWS])
"""`NormalLaw.respond` of the law with the number that stands first."""


@allocation_free_kernel
def is_positive_definite(W: FloatArray, m: int, work: FloatArray) -> bool:
    """Return whether the symmetric part of the leading m x m block of W is positive definite, by Cholesky's method.

    `work` (m or more, m or more) is scratch.
    """
    for i in range(m):
        for j in range(i + 1):
            total = 0.5 * (W[i, j] + W[j, i])
            for c in range(j):
                total -= work[i, c] * work[j, c]
            if i == j:
                if not total > 0.0:
                    return False
                work[i, i] = math.sqrt(total)
            else:
                work[i, j] = total / work[j, j]
    return True


@allocation_free_kernel
def projected_gauss_seidel(
    law: FloatArray, W: FloatArray, b: FloatArray, before: FloatArray, m: int, lam_out: FloatArray
) -> int:
    """Solve for the normal forces `lam_out` (m,), N, by projected Gauss-Seidel. Returns SOLVED or UNSOLVED.

    Sweeps begin with zero forces and end when no force changes by more than 1e-14 of the largest. After 400 sweeps the
    problem is unsolved.

    - law: number of the law of the normal force in the registry, then its parameters.
    - W (m, m): change of each gap per unit of each force, m/N.
    - b (m,): gaps before the forces, m.
    - before (m,): gaps at step n - 1, m, for a law with a rate.
    - m: number of contacts.
    """
    place, numbers = int(law[0]), law[1:]
    for i in range(m):
        lam_out[i] = 0.0
    for _ in range(SWEEPS):
        change, largest = 0.0, 0.0
        for i in range(m):
            residual = b[i]
            for j in range(m):
                residual += W[i, j] * lam_out[j]
            value = respond(place, numbers, lam_out[i], residual, W[i, i], before[i])
            change = max(change, abs(value - lam_out[i]))
            largest = max(largest, value)
            lam_out[i] = value
        if change <= TOLERANCE * largest:
            return SOLVED
    return UNSOLVED


@allocation_free_kernel
def _leaving_row(tableau: FloatArray, basis: IntArray, entering: int, m: int) -> int:
    """Return the row of the smallest ratio; -1 on a ray.

    Ties go to the artificial variable's row, which ends the pivoting, else to the first row.
    """
    best, row = math.inf, -1
    for i in range(m):
        if tableau[i, entering] > 1e-14:
            ratio = tableau[i, 2 * m + 1] / tableau[i, entering]
            if ratio < best or (ratio == best and basis[i] == 2 * m):
                best, row = ratio, i
    return row


@allocation_free_kernel
def _pivot(tableau: FloatArray, row: int, column: int, m: int) -> None:
    pivot = tableau[row, column]
    for j in range(2 * m + 2):
        tableau[row, j] /= pivot
    for i in range(m):
        factor = tableau[i, column]
        if i != row and factor != 0.0:
            for j in range(2 * m + 2):
                tableau[i, j] -= factor * tableau[row, j]


@allocation_free_kernel
def _fill_tableau(W: FloatArray, b: FloatArray, m: int, scale: float, tableau: FloatArray, basis: IntArray) -> int:
    """Write I w - W z - 1 z0 = b, scaled so that lam = scale z. Return the row of the most negative b."""
    worst = 0
    for i in range(m):
        for j in range(m):
            tableau[i, j] = 0.0
            tableau[i, m + j] = -W[i, j] * scale
        tableau[i, i] = 1.0
        tableau[i, 2 * m] = -1.0
        tableau[i, 2 * m + 1] = b[i]
        basis[i] = i
        if b[i] < b[worst]:
            worst = i
    return worst


@allocation_free_kernel
def lemke(W: FloatArray, b: FloatArray, m: int, lam_out: FloatArray, tableau: FloatArray, basis: IntArray) -> int:
    """Solve 0 <= lam _|_ b + W lam >= 0 for `lam_out` (m,), N, by Lemke's complementary pivoting.

    Cottle, Pang, Stone, The Linear Complementarity Problem, 4.4. W (m, m) and b (m,) are as in
    `projected_gauss_seidel`; `tableau` (m, 2 m + 2) and `basis` (m,) are scratch. All arrays may be larger. Returns
    SOLVED, or UNSOLVED when the pivoting ends on a ray, after 50 (m + 1) pivots, and where W is zero.
    """
    size = 0.0
    for i in range(m):
        lam_out[i] = 0.0
        for j in range(m):
            size = max(size, abs(W[i, j]))
    if size == 0.0:
        return UNSOLVED
    row = _fill_tableau(W, b, m, 1.0 / size, tableau, basis)
    if b[row] >= 0.0:
        return SOLVED
    entering = 2 * m
    for _ in range(50 * (m + 1)):
        _pivot(tableau, row, entering, m)
        left = basis[row]
        basis[row] = entering
        if left == 2 * m:
            for i in range(m):
                if m <= basis[i] < 2 * m:
                    lam_out[basis[i] - m] = max(0.0, tableau[i, 2 * m + 1]) / size
            return SOLVED
        entering = left + m if left < m else left - m
        row = _leaving_row(tableau, basis, entering, m)
        if row < 0:
            return UNSOLVED
    return UNSOLVED


@allocation_free_kernel
def solve_normal(
    law: FloatArray,
    W: FloatArray,
    b: FloatArray,
    m: int,
    lam_out: FloatArray,
    square: FloatArray,
    tableau: FloatArray,
    basis: IntArray,
) -> int:
    """Solve for the normal forces of the first m contacts, N, into `lam_out`. Returns SOLVED or UNSOLVED.

    Where the symmetric part of W is positive definite the solution is unique, and projected Gauss-Seidel is tried
    first. Where it is not, or fails, Lemke's pivoting is used for rigid contact; any other law is then unsolved. `law`
    is the number of the law in the registry and its parameters; W and b are as in `projected_gauss_seidel`. `square`
    (m, m), `tableau` (m, 2 m + 2) and `basis` (m,) are scratch. All arrays may be larger. For a law with a rate, the
    caller writes the gaps at step n - 1 into the first row of `tableau`.
    """
    if is_positive_definite(W, m, square) and projected_gauss_seidel(law, W, b, tableau[0], m, lam_out) == SOLVED:
        return SOLVED
    return lemke(W, b, m, lam_out, tableau, basis) if law[0] == RIGID else UNSOLVED
