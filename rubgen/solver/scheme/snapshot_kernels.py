"""States that a turn leaves behind at chosen steps."""

from __future__ import annotations

from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.contact.contact_kernels import ContactWork
from rubgen.jit import inlined_kernel
from rubgen.solver.scheme.motion_kernels import Motion


class Marks(NamedTuple):
    """Rising numbers `steps` (marks,) in 1 .. steps a turn, and the states there.

    `z` (marks, 2, any) holds z at the step before and at the step, `held` (marks, 2, n_blades) the scheme's gaps there.
    """

    steps: IntArray
    z: FloatArray
    held: FloatArray


@inlined_kernel
def keep_mark(marks: Marks, mark: int, before: Motion, now: Motion, work: ContactWork) -> int:
    """Keep a state under the number `mark`; gives the next one."""
    for i in range(now.z.shape[0]):
        marks.z[mark, 0, i] = before.z[i]
        marks.z[mark, 1, i] = now.z[i]
    for k in range(marks.held.shape[2]):
        marks.held[mark, 0, k] = work.held[0, k]
        marks.held[mark, 1, k] = work.held[1, k]
    return mark + 1
