"""Matrices that fall into blocks, and the way between the coordinates in which they do and the physical ones.

The coordinates are z: the blade tips as harmonics over the blades (nodal diameters), the others as they are, arranged
so that the blocks of all matrices are read in rows of eight numbers (`solver.blocks`).
"""

from __future__ import annotations

from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.jit import allocation_free_kernel, inlined_kernel
from rubgen.solver.lanes_kernels import add_lines, dot_lines, gather_lines, set_two_lines
from rubgen.vector_kernels import LANES


class Product(NamedTuple):
    """A matrix in blocks: `lines` (any, 5), one for each row of eight results (`lanes_kernels`), `entries` (any, 8)."""

    lines: IntArray
    entries: FloatArray


class Scheme(NamedTuple):
    """The free step q* = now q_n + before q_n-1 + constant, and A^-1, whose entries share the lines of both."""

    lines: IntArray
    now: FloatArray
    before: FloatArray
    constant: FloatArray
    inverse: FloatArray


class Harmonics(NamedTuple):
    """Where the coordinates stand in z, and the harmonics over the blades.

    `basis` (blades, width) holds the harmonics, orthonormal, one row for each blade, padded to a multiple of eight.
    Of an even number of blades, the first half of the harmonics keep their sign by half a turn and the others change
    it; so the sums of both halves over half of the blades tell all. `columns` (any, 8) and `lines` (any, 5) are those
    sums. `places` (3, width) are the numbers of z of the harmonics
    of the radial, tangential and axial tip coordinate, `rest` (n - 3 blades,) those of the other coordinates.
    """

    basis: FloatArray
    columns: FloatArray
    lines: IntArray
    places: IntArray
    rest: IntArray


class Motion(NamedTuple):
    """One state: z; radial and tangential tip coordinates (2, width), one column for each blade; q (n,).

    Of q, the coordinates behind the tips always hold, those of a tip only where a contact has asked for them.
    """

    z: FloatArray
    tips: FloatArray
    q: FloatArray


@inlined_kernel
def multiply(product: Product, z: FloatArray, out: FloatArray) -> None:
    """Out += matrix z."""
    add_lines(product.lines, product.entries, z, out)


@inlined_kernel
def quadratic(product: Product, left: FloatArray, right: FloatArray) -> float:
    """left^T matrix right."""
    total: float = dot_lines(product.lines, product.entries, right, left)
    return total


@allocation_free_kernel
def bilinear(product: Product, left: FloatArray, right: FloatArray) -> float:
    """`quadratic`, for callers outside of kernels."""
    return quadratic(product, left, right)


@inlined_kernel
def free_step(scheme: Scheme, before: FloatArray, now: FloatArray, after: FloatArray) -> None:
    """q* in z."""
    set_two_lines(scheme.lines, scheme.now, scheme.before, now, before, scheme.constant, after)


@inlined_kernel
def recover_tips(harmonics: Harmonics, z: FloatArray, share_work: FloatArray, tips_out: FloatArray) -> None:
    """The first `tips_out.shape[0]`, two or three, of radial, tangential, axial coordinate of all tips.

    `share_work` (3, any) is scratch: the sums over the harmonics of each coordinate.
    """
    blades, many, sums = harmonics.basis.shape[0], tips_out.shape[0], share_work
    half = blades // 2 if blades % 2 == 0 else blades
    gather_lines(harmonics.lines, harmonics.columns, z, harmonics.places, 0, 1, sums)
    if many == 3:
        gather_lines(harmonics.lines, harmonics.columns, z, harmonics.places, 2, 2, sums)
    other = (half + LANES - 1) // LANES * LANES
    for a in range(many):
        if half == blades:
            for k in range(half):
                tips_out[a, k] = sums[a, k]
        else:
            for k in range(half):
                tips_out[a, k] = sums[a, k] + sums[a, other + k]
                tips_out[a, half + k] = sums[a, k] - sums[a, other + k]


@inlined_kernel
def recover_rest(harmonics: Harmonics, z: FloatArray, q_out: FloatArray) -> None:
    """The coordinates behind the tips."""
    start = 3 * harmonics.basis.shape[0]
    for i in range(harmonics.rest.shape[0]):
        q_out[start + i] = z[harmonics.rest[i]]


@inlined_kernel
def recover(harmonics: Harmonics, motion: Motion, share_work: FloatArray) -> None:
    """Tips and the other coordinates of a motion from its z."""
    recover_tips(harmonics, motion.z, share_work, motion.tips)
    recover_rest(harmonics, motion.z, motion.q)


@allocation_free_kernel
def recover_all(
    harmonics: Harmonics, z: FloatArray, share_work: FloatArray, tips_work: FloatArray, q: FloatArray
) -> None:
    """All of q (n,) from z; `tips_work` (3, width) is scratch."""
    recover_tips(harmonics, z, share_work, tips_work)
    for k in range(harmonics.basis.shape[0]):
        for a in range(3):
            q[3 * k + a] = tips_work[a, k]
    recover_rest(harmonics, z, q)


@inlined_kernel
def recover_blade(harmonics: Harmonics, motion: Motion, blade: int) -> None:
    """The three coordinates of one tip in q."""
    axial = 0.0
    for j in range(harmonics.basis.shape[0]):
        axial += harmonics.basis[blade, j] * motion.z[harmonics.places[2, j]]
    motion.q[3 * blade] = motion.tips[0, blade]
    motion.q[3 * blade + 1] = motion.tips[1, blade]
    motion.q[3 * blade + 2] = axial


@inlined_kernel
def spread_tip_force(harmonics: Harmonics, blade: int, force: FloatArray, scale: float, z_force: FloatArray) -> None:
    """Add a force (3,) on one tip, times `scale`, to the force in z."""
    for a in range(3):
        size = scale * force[a]
        for j in range(harmonics.basis.shape[0]):
            z_force[harmonics.places[a, j]] += size * harmonics.basis[blade, j]
