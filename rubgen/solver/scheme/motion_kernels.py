"""The coordinates at one step: all in blocks, and the physical coordinates that contact needs."""

from typing import NamedTuple

from rubgen.arrays import FloatArray
from rubgen.jit import inlined_kernel
from rubgen.linalg.harmonic_kernels import Harmonics, recover_rest, recover_tips


class Motion(NamedTuple):
    """The coordinates at one step: z in blocks, and the physical coordinates that contact needs."""

    z: FloatArray
    """All coordinates in the order of the blocks (`linalg.blocks`), padded to rows of eight."""
    tips: FloatArray
    """Radial and tangential coordinates of the tips (2, n_blades or more), one column for each blade."""
    q: FloatArray
    """Physical coordinates (n,). A tip's are valid only after `recover_blade`; all others always are."""


class MotionBuffer(NamedTuple):
    """Room for three motions, one in each row. Which row is which step changes with every step; see `motion_at`."""

    z: FloatArray
    """(3, any)."""
    tips: FloatArray
    """(3, 2, width)."""
    q: FloatArray
    """(3, n)."""


@inlined_kernel
def motion_at(buffer: MotionBuffer, row: int) -> Motion:
    """Return the motion in a row of the buffer; its arrays are views.

    Kernels that keep three rows turn over three numbers in a step. With three `Motion`s they would turn over all sizes
    and strides of nine arrays, which the compiler then does not know, and a step would take a fifth longer.
    """
    return Motion(buffer.z[row], buffer.tips[row], buffer.q[row])


@inlined_kernel
def put_in_order(buffer: MotionBuffer, first: int) -> None:
    """Turn over the rows of the buffer: row `first` (0, 1 or 2) comes first, then the next rows, with 0 after 2."""
    second, third = (first + 1) % 3, (first + 2) % 3
    for i in range(buffer.z.shape[1]):
        z = buffer.z[first, i], buffer.z[second, i], buffer.z[third, i]
        buffer.z[0, i], buffer.z[1, i], buffer.z[2, i] = z
    for a in range(2):
        for k in range(buffer.tips.shape[2]):
            tip = buffer.tips[first, a, k], buffer.tips[second, a, k], buffer.tips[third, a, k]
            buffer.tips[0, a, k], buffer.tips[1, a, k], buffer.tips[2, a, k] = tip
    for i in range(buffer.q.shape[1]):
        q = buffer.q[first, i], buffer.q[second, i], buffer.q[third, i]
        buffer.q[0, i], buffer.q[1, i], buffer.q[2, i] = q


@inlined_kernel
def recover(harmonics: Harmonics, motion: Motion, share_work: FloatArray) -> None:
    """Compute `tips` of a motion, and the coordinates behind the tips in its `q`, from its z.

    `share_work` is scratch, as in `recover_tips`.
    """
    recover_tips(harmonics, motion.z, share_work, motion.tips)
    recover_rest(harmonics, motion.z, motion.q)


@inlined_kernel
def recover_blade(harmonics: Harmonics, motion: Motion, blade: int) -> None:
    """Compute the three coordinates of the tip of one blade in `q` of a motion, from its z and `tips`."""
    axial = 0.0
    for j in range(harmonics.basis.shape[0]):
        axial += harmonics.basis[blade, j] * motion.z[harmonics.places[2, j]]
    motion.q[3 * blade] = motion.tips[0, blade]
    motion.q[3 * blade + 1] = motion.tips[1, blade]
    motion.q[3 * blade + 2] = axial


@inlined_kernel
def copy_motion(source: Motion, target: Motion) -> None:
    """Copy the coordinates of `source` into `target`."""
    for i in range(source.z.shape[0]):
        target.z[i] = source.z[i]
    for a in range(2):
        for k in range(source.tips.shape[1]):
            target.tips[a, k] = source.tips[a, k]
    for i in range(source.q.shape[0]):
        target.q[i] = source.q[i]
