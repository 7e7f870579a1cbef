"""Change z to physical coordinates and back: blade tips are harmonics over the blades, the others are unchanged.

z are the coordinates in the order of the blocks (`linalg.blocks`), padded to rows of eight.
"""

from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.jit import allocation_free_kernel, inlined_kernel
from rubgen.linalg.lanes_kernels import gather_lines
from rubgen.linalg.vector_kernels import LANES


class Harmonics(NamedTuple):
    """The indices of the coordinates in z, and the harmonics over the blades.

    With an even number of blades, half of the harmonics keep their sign after half a turn, and the other half change
    it. The sums of both halves over half of the blades therefore determine all tips.
    """

    basis: FloatArray
    """The harmonics (blades, width), orthonormal, one row a blade. The width is padded to a multiple of eight."""
    columns: FloatArray
    """Entries of the sums over the harmonics (any, 8)."""
    lines: IntArray
    """Lines of these sums (any, 5)."""
    places: IntArray
    """Indices in z of the harmonics of the radial, tangential and axial tip coordinate (3, width)."""
    rest: IntArray
    """Indices in z of the other coordinates (n - 3 blades,)."""


@inlined_kernel
def recover_tips(harmonics: Harmonics, z: FloatArray, share_work: FloatArray, tips_out: FloatArray) -> None:
    """Compute the coordinates of all tips from z, into the rows of `tips_out`: radial, tangential and axial.

    The coordinates have the unit of z: m, or m/s of a velocity.

    - share_work (3, `share_width(n_blades)` or more): scratch.
    - tips_out (2 or 3, n_blades or more): written, one column for each blade. Further columns are not changed. The
      axial coordinate is computed if there are three rows.
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
    """Write the coordinates behind the tips from z into `q_out` (n,)."""
    behind = q_out[3 * harmonics.basis.shape[0] :]
    for i in range(harmonics.rest.shape[0]):
        behind[i] = z[harmonics.rest[i]]


@allocation_free_kernel
def recover_all(
    harmonics: Harmonics, z: FloatArray, share_work: FloatArray, tips_work: FloatArray, q: FloatArray
) -> None:
    """Compute all coordinates from z, into `q` (n,): radial, tangential, axial of each tip, then the others.

    `share_work` is scratch as in `recover_tips`, `tips_work` (3, n_blades or more) too.
    """
    recover_tips(harmonics, z, share_work, tips_work)
    for k in range(harmonics.basis.shape[0]):
        for a in range(3):
            q[3 * k + a] = tips_work[a, k]
    recover_rest(harmonics, z, q)


@inlined_kernel
def spread_tip_force(harmonics: Harmonics, blade: int, force: FloatArray, scale: float, z_force: FloatArray) -> None:
    """Add `scale` times a force (3,) on the tip of one blade to the force `z_force` in z.

    The force is radial, tangential, axial, in N.
    """
    for a in range(3):
        size = scale * force[a]
        for j in range(harmonics.basis.shape[0]):
            z_force[harmonics.places[a, j]] += size * harmonics.basis[blade, j]
