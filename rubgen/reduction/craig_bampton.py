"""Reduce one component by Craig and Bampton's method, with the rotational symmetry of the disk.

O_d is the disk centre.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve, eigh
from scipy.sparse.linalg import LinearOperator, eigsh

from rubgen.arrays import FloatArray, IntArray, SparseMatrix
from rubgen.errors import UserError
from rubgen.fem.constraints import blade_rotation, factorize

# Up to this many slave DoFs the dense eigen-solver is used; it alone can give all modes.
DENSE_LIMIT = 1000
# A mode whose mass is below this share of the largest one's (mass over stiffness) moves no mass: it is static.
MASSLESS = 1e-13
FIRST = 12
"""Number of masters that are solved for: O_d and the rim node of blade 0."""


@dataclass(frozen=True, kw_only=True)
class Turning:
    """Rotations of the disk by whole blade pitches. The disk's DoFs are O_d first, then six a node."""

    place: IntArray
    """(blades, nodes + 1): after a turn by k pitches, node i is where node place[k, i] was."""
    rotation: FloatArray
    """R_k (blades, 6, 6)."""

    def copy_columns(self, V: FloatArray) -> None:
        """Fill the columns of the rim nodes 1, 2, ... of V with rotated copies of the columns of rim node 0.

        V is (n, 6 + 6 blades + modes), C-contiguous, with the columns of O_d first, then six for each rim node. It is
        changed in place.
        """
        first = V[:, 6:FIRST].reshape(-1, 6, 6)
        for k in range(1, len(self.place)):
            R = self.rotation[k]
            turned = R @ first @ R.T
            V.reshape(-1, 6, V.shape[1])[self.place[k], :, 6 * k + 6 : 6 * k + 12] = turned

    def project(self, X: SparseMatrix, V: FloatArray, *, skew: bool = False) -> FloatArray:
        """Return V^T X V of a symmetric or `skew` X (n, n), with V (n, 6 + 6 blades + modes) from `copy_columns`.

        X must be a matrix of the disk, which the turns do not change. Only the columns of O_d, node 0 and the modes are
        multiplied; the products of all other columns follow by symmetry.
        """
        blades, size = len(self.place), V.shape[1]
        modes = slice(6 + 6 * blades, size)
        solved = np.r_[:FIRST, modes]
        P = np.zeros((size, size))
        P[:, solved] = V.T @ (X @ V[:, solved])
        rim = P[6 : modes.start, 6:FIRST].reshape(blades, 6, 6)
        for k in range(1, blades):
            R, columns = self.rotation[k], slice(6 * k + 6, 6 * k + 12)
            P[:6, columns] = R @ P[:6, 6:FIRST] @ R.T
            P[6 : modes.start, columns] = (R @ np.roll(rim, k, axis=0) @ R.T).reshape(-1, 6)
        P[modes, FIRST : modes.start] = (-1.0 if skew else 1.0) * P[FIRST : modes.start, modes].T
        return P


def disk_turning(rings: IntArray, blades: int) -> Turning:
    """Make the rotations of a disk by whole blade pitches.

    `rings` (any,) is the number of nodes on each ring, in the order of the nodes: a multiple of `blades`.
    """
    starts = 1 + np.concatenate([[0], np.cumsum(rings)[:-1]])
    place = np.zeros((blades, 1 + int(rings.sum())), dtype=np.int64)
    for start, count in zip(starts, rings, strict=True):
        on_ring = np.arange(count)
        shift = (count // blades) * np.arange(blades)[:, None]
        place[:, start : start + count] = start + (on_ring + shift) % count
    angles = 2 * np.pi * np.arange(blades) / blades
    return Turning(place=place, rotation=np.stack([blade_rotation(angle) for angle in angles]))


def craig_bampton(
    M: SparseMatrix, K: SparseMatrix, masters: IntArray, modes: int, turning: Turning | None = None
) -> FloatArray:
    """Return the basis V (n, masters + modes) of constraint modes and mass-normalised fixed-interface modes.

    q = V p, its rows in the order of the DoFs. For the masters V is [I, 0], for all other DoFs [-K_ss^-1 K_sm, Phi],
    with Phi the lowest modes of K_ss Phi = M_ss Phi omega^2 (Craig and Bampton 1968), ascending. p begins with the
    masters' own displacements. K_ss must be positive definite. M_ss may be singular: massless directions follow
    statically. The entry of a mode with the largest size is positive.

    - M, K (n, n): mass and stiffness.
    - masters: indices of the DoFs that are kept. With `turning` they are O_d, then six of each rim node in the order of
      the blades.
    - modes: number of fixed-interface modes.
    - turning: rotations of the disk. Only the first twelve masters are solved for; the other shapes are rotated copies.
      None solves for all.

    Raises UserError where there are fewer modes with mass than `modes`. With more than DENSE_LIMIT DoFs that are not
    kept, this is not checked. A K_ss that cannot be factorised raises LinAlgError or RuntimeError. Tests:
    tests/reduction/test_craig_bampton.py.
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
