"""States that a turn leaves behind at chosen steps."""

from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.contact.contact_kernels import ContactWork
from rubgen.jit import inlined_kernel
from rubgen.solver.scheme.motion_kernels import Motion


class Snapshots(NamedTuple):
    """The motion at chosen steps of a turn."""

    steps: IntArray
    """Rising numbers of the steps (snapshots,), from 1 to the steps of a turn."""
    z: FloatArray
    """z at the step before and at the step (snapshots, 2, any)."""
    step_gaps: FloatArray
    """The scheme's gaps there (snapshots, 2, n_blades), m."""


@inlined_kernel
def keep_snapshot(snapshots: Snapshots, number: int, before: Motion, now: Motion, work: ContactWork) -> int:
    """Keep a state under a number; returns the next number."""
    for i in range(now.z.shape[0]):
        snapshots.z[number, 0, i] = before.z[i]
        snapshots.z[number, 1, i] = now.z[i]
    for k in range(snapshots.step_gaps.shape[2]):
        snapshots.step_gaps[number, 0, k] = work.step_gaps[0, k]
        snapshots.step_gaps[number, 1, k] = work.step_gaps[1, k]
    return number + 1
