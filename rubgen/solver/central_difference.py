"""Matrices of the central difference scheme with Lagrange multipliers, for the kernels."""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

from rubgen.arrays import FloatArray
from rubgen.reduction.model import SpinningSystem
from rubgen.solver.energy_kernels import Book
from rubgen.solver.step_kernels import Block

ROW_MULTIPLE = 8
RANK_TOLERANCE = 1e-13


def padded_columns(matrix: FloatArray) -> FloatArray:
    """Row j is column j of the matrix, padded with zeros to a multiple of eight numbers."""
    m, columns = matrix.shape
    out = np.zeros((columns, -(-m // ROW_MULTIPLE) * ROW_MULTIPLE))
    out[:, :m] = matrix.T
    return out


def scheme_block(M: FloatArray, C: FloatArray, K: FloatArray, force: FloatArray, dt: float) -> Block:
    """The free step q* = P1 q_n + P2 q_n-1 + p0 and A^-1 of one block.

    A = M / dt^2 + C / (2 dt), P1 = A^-1 (2 M / dt^2 - K), P2 = -A^-1 (M / dt^2 - C / (2 dt)), p0 = A^-1 force, with
    C and K unsymmetric as they are (Carpenter, Taylor, Katona 1991).
    """
    inertia, drag = M / dt**2, C / (2 * dt)
    inverse = la.inv(inertia + drag)
    return Block(
        now=padded_columns(inverse @ (2 * inertia - K)),
        before=padded_columns(-inverse @ (inertia - drag)),
        constant=padded_columns((inverse @ force)[:, None])[0],
        inverse=padded_columns(inverse),
    )


def scheme_blocks(system: SpinningSystem, dt: float) -> tuple[Block, Block]:
    """Blocks of blisk and casing. Raises ValueError when anything but contact couples them."""
    start = system.casing_start
    for matrix in (system.M, system.C, system.K):
        if np.any(matrix[:start, start:]) or np.any(matrix[start:, :start]):
            raise ValueError("M, C and K must not couple blisk and casing: contact alone does")
    blisk, casing = (
        scheme_block(system.M[part, part], system.C[part, part], system.K[part, part], system.force[part], dt)
        for part in (slice(0, start), slice(start, None))
    )
    return blisk, casing


def half_diagonal_triangle(C: FloatArray) -> FloatArray:
    """Padded columns of the lower triangle of C_sym with half its diagonal: d^T C d = 2 d^T (triangle d)."""
    symmetric = (C + C.T) / 2
    return padded_columns(np.tril(symmetric, -1) + np.diag(np.diag(symmetric)) / 2)


def energy_book(system: SpinningSystem) -> Book:
    """Matrices of the energy terms, with K_skew as a product of its few columns, and works of zero."""
    start = system.casing_start
    skew = (system.K - system.K.T) / 2
    left, size, right = la.svd(skew)
    rank = int(np.sum(size > RANK_TOLERANCE * np.abs(system.K).max()))
    factors = np.zeros((2, rank + 1, skew.shape[0]))
    factors[0, 0] = system.force
    factors[0, 1:], factors[1, 1:] = (left[:, :rank] * size[:rank]).T, right[:rank]
    columns = padded_columns(factors[0]), padded_columns(factors[1])
    return Book(
        blisk_damping=half_diagonal_triangle(system.C[:start, :start]),
        casing_damping=half_diagonal_triangle(system.C[start:, start:]),
        left=columns[0],
        right=columns[1],
        M=np.ascontiguousarray((system.M + system.M.T) / 2),
        K=np.ascontiguousarray((system.K + system.K.T) / 2),
        products=np.zeros((2, columns[0].shape[1])),
        works=np.zeros(8),
    )
