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
