"""Build the matrices of the central difference scheme with Lagrange multipliers, for the kernels."""

import numpy as np
import scipy.linalg as la

from rubgen.arrays import FloatArray
from rubgen.linalg.block_kernels import Product
from rubgen.linalg.blocks import Blocks, aligned, entry_rows
from rubgen.linalg.vector_kernels import LANES
from rubgen.reduction.model import SpinningSystem
from rubgen.solver.scheme.free_step_kernels import Scheme
from rubgen.solver.scheme.model_kernels import EnergyTerms

PAIR_COST = 16
"""Each pair of vectors must stand for this many times as many rows of entries of a product as z has. A pair reads four
times as many, a and b and both vectors, so pairs read a quarter at most."""

LARGE_BYTES = 2**15
"""A damping matrix of more bytes is read once for several steps: the nearest cache does not keep it between them."""


def scheme(M: FloatArray, C: FloatArray, K: FloatArray, force: FloatArray, dt: float, blocks: Blocks) -> Scheme:
    """Build the step without contact forces, q* = P1 q_n + P2 q_n-1 + p0, and A^-1, packed in `blocks`.

    A = M / dt^2 + C / (2 dt), P1 = A^-1 (2 M / dt^2 - K), P2 = -A^-1 (M / dt^2 - C / (2 dt)), p0 = A^-1 force. C and K
    may be unsymmetric (Carpenter, Taylor, Katona 1991). The arguments are in the coordinates q: matrices (n, n), the
    constant `force` (n,) in N, `dt` in s. The result is in z, the coordinates of `Blocks`: P1 is `now`, P2 `before`, p0
    `constant` and A^-1 `inverse`. Entries between blocks are dropped, so `blocks` must have been found for these
    matrices. Stability at `dt` is not checked.
    """
    inertia, drag = M / dt**2, C / (2 * dt)
    inverse = la.inv(inertia + drag)
    now, before = inverse @ (2 * inertia - K), -inverse @ (inertia - drag)
    products = [blocks.product(matrix) for matrix in (now, before, inverse)]
    return Scheme(
        lines=products[0].lines,
        now=products[0].entries,
        before=products[1].entries,
        constant=blocks.to_z(inverse @ force),
        inverse=products[2].entries,
    )


def compliances(system: SpinningSystem, dt: float) -> tuple[FloatArray, FloatArray]:
    """Return A^-1 between tip coordinates (3 n_blades, 3 n_blades), and of casing modes (n_casing, n_casing).

    Both are transposed. A = M / dt^2 + C / (2 dt), with `dt` in s.
    """
    A = system.M / dt**2 + system.C / (2 * dt)
    inverse = la.inv(A)
    tips, start = 3 * system.n_blades, system.casing_start
    # Transposed: the kernels walk along the columns of A^-1.
    return aligned(inverse[:tips, :tips].T), aligned(inverse[start:, start:].T)


def energy_terms(system: SpinningSystem, blocks: Blocks, *, zeros: bool = False) -> EnergyTerms:
    """Build the matrices of the energy terms in blocks.

    With `zeros` entries that are zero are stored too, and the circulatory stiffness is never stored as pairs: all
    speeds then have arrays of the same shapes.
    """
    force = blocks.to_z(system.force)
    places = np.arange(force.size) if zeros else np.flatnonzero(force)
    circulatory, pairs = _circulatory_terms(system.K, blocks, zeros=zeros)
    damping = blocks.damping(system.C, whole=zeros)
    return EnergyTerms(
        damping=damping,
        circulatory=circulatory,
        circulatory_pairs=pairs,
        M=blocks.product((system.M + system.M.T) / 2),
        K=blocks.product((system.K + system.K.T) / 2),
        force=force[places],
        force_places=places,
        waits=damping.entries.nbytes > LARGE_BYTES,
    )


def _circulatory_terms(K: FloatArray, blocks: Blocks, *, zeros: bool) -> tuple[Product, FloatArray]:
    """Return K_skew as a product or as pairs of vectors, the other empty; with `zeros` always as a product.

    Dampers in the inertial frame give it the rank 4: two pairs, one of the lateral dampers and one of those of tilt. In
    a large block their product is dense all the same, and pairs are read much faster. At a changing speed the Euler
    term Omega' G has full rank.
    """
    skew, none = (K - K.T) / 2, np.zeros((0, 2, blocks.rows * LANES))
    if zeros:
        return blocks.product(skew), none
    product = blocks.without_zeros(skew, K)
    most = int(entry_rows(product.lines).sum()) // (PAIR_COST * blocks.rows)
    pairs = blocks.skew_pairs(skew, K, most) if most else None
    return (product, none) if pairs is None else (Product(product.lines[:0], product.entries[:0]), pairs)
