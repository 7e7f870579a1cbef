"""Craig-Bampton reduction of one component."""

import numpy as np
from scipy.linalg import cho_factor, cho_solve, eigh
from scipy.sparse.linalg import LinearOperator, eigsh

from rubgen.arrays import FloatArray, IntArray, SparseMatrix
from rubgen.errors import UserError
from rubgen.fem.statics import factorize
from rubgen.reduction.cyclic import FIRST, Turning

# Up to this many slave DoFs the dense eigen-solver is used; it alone can give all modes.
DENSE_LIMIT = 1000
# A mode whose mass is below this share of the largest one's (mass over stiffness) moves no mass: it is static.
MASSLESS = 1e-13


def craig_bampton(
    M: SparseMatrix, K: SparseMatrix, masters: IntArray, modes: int, turning: Turning | None = None
) -> FloatArray:
    """Basis (n, masters + modes) of constraint modes and mass-normalised fixed-interface modes.

    q = V p with V = [[I, 0], [-K_ss^-1 K_sm, Phi]], Phi the lowest modes of K_ss Phi = M_ss Phi omega^2
    (Craig and Bampton 1968). p holds the masters' own displacements first. K_ss must be positive definite, M_ss may be
    singular: massless directions follow statically. Signs are fixed by the largest entry of each mode. Raises
    UserError when more modes are asked for than carry mass. With `turning` the first twelve masters are solved for, and
    the others' shapes are turned copies (`cyclic`). Tests: tests/reduction/test_craig_bampton.py.
    """
    slaves = np.setdiff1d(np.arange(K.shape[0]), masters)
    K_ss, M_ss = K[slaves][:, slaves], M[slaves][:, slaves]
    solved = masters if turning is None else masters[:FIRST]
    K_sm = K[slaves][:, solved].toarray()
    solve = _dense if len(slaves) <= DENSE_LIMIT else _sparse
    constraint, fixed = solve(M_ss, K_ss, K_sm, modes)
    basis = np.zeros((K.shape[0], len(masters) + modes))
    basis[masters, np.arange(len(masters))] = 1.0
    basis[slaves, : len(solved)] = constraint
    basis[slaves, len(masters) :] = _fix_signs(fixed)
    if turning is not None:
        turning.copy_columns(basis)
    return basis


def _dense(M: SparseMatrix, K: SparseMatrix, K_sm: FloatArray, modes: int) -> tuple[FloatArray, FloatArray]:
    stiffness = K.toarray()
    constraint = -cho_solve(cho_factor(stiffness), K_sm) if len(stiffness) else np.zeros_like(K_sm)
    if modes == 0:
        return constraint, np.zeros((len(stiffness), 0))
    # M x = mu K x with mu = 1 / omega^2 stays regular for massless directions.
    mass, n = M.toarray(), len(stiffness)
    compliance, vectors = eigh(mass, stiffness, subset_by_index=(max(n - modes, 0), n - 1))
    compliance, vectors = compliance[::-1], vectors[:, ::-1]
    if modes > n or compliance[-1] <= MASSLESS * compliance[0]:
        every: FloatArray = eigh(mass, stiffness, eigvals_only=True)
        available = int(np.count_nonzero(every > MASSLESS * every[-1]))
        raise UserError(f"reduction: {modes} modes of a component that has {available}; give at most {available}")
    return constraint, vectors / np.sqrt(compliance)


def _sparse(M: SparseMatrix, K: SparseMatrix, K_sm: FloatArray, modes: int) -> tuple[FloatArray, FloatArray]:
    factor = factorize(K)
    constraint = -factor.solve(K_sm)
    if modes == 0:
        return constraint, np.zeros((K.shape[0], 0))
    inverse = LinearOperator(K.shape, matvec=factor.solve, dtype=np.float64)
    start = np.sin(1.0 + np.arange(K.shape[0]))
    squares, vectors = eigsh(K, k=modes, M=M, sigma=0.0, OPinv=inverse, v0=start, tol=1e-12)
    order = np.argsort(squares)
    vectors = vectors[:, order]
    return constraint, vectors / np.sqrt(np.einsum("ij,ij->j", vectors, M @ vectors))


def _fix_signs(modes: FloatArray) -> FloatArray:
    if modes.size == 0:
        return modes
    largest = modes[np.argmax(np.abs(modes), axis=0), np.arange(modes.shape[1])]
    modes *= np.sign(largest)
    return modes
