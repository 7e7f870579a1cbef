"""The state of a run, which every step changes, the scratch of a step, and the snapshots that a turn leaves.

z are the coordinates in the order of the blocks (`linalg.blocks`). d = (q_n+1 - q_n-1) / 2 is the change in a step.
"""

from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.contact.contact_kernels import ContactWork
from rubgen.contact.liner_kernels import Wear
from rubgen.jit import inlined_kernel
from rubgen.solver.scheme.motion_kernels import Motion, MotionBuffer
from rubgen.solver.supports.support_kernels import SupportState

OK, CONTACT_UNSOLVED, DIVERGED, ENERGY, FILM_CLOSED = range(5)
"""How a step or a run ended."""


class Coordinates(NamedTuple):
    """Physical coordinates of three steps, each (n,). Within a turn only tips of blades in contact are valid."""

    before: FloatArray
    """q at step n - 1."""
    now: FloatArray
    """q at step n."""
    after: FloatArray
    """q at step n + 1."""
    change: FloatArray
    """d = (q_n+1 - q_n-1) / 2, or the velocity d / dt."""


class Waiting(NamedTuple):
    """Steps whose works of the linear forces are still to be added, and room for these; see `book_linear_works`."""

    change: FloatArray
    """d of each step (TOGETHER, size of z), in z."""
    now: FloatArray
    """z_n of each step (TOGETHER, size of z)."""
    damping: FloatArray
    """d^T (triangle d) of each step (TOGETHER,)."""
    circulatory: FloatArray
    """d^T K_skew q of each step (TOGETHER,)."""


class Scratch(NamedTuple):
    """Arrays that every step writes before it reads them."""

    free: Motion
    """The free motion q*, to go back to."""
    z_change: FloatArray
    """d in z."""
    z_force: FloatArray
    """A force in z."""
    share: FloatArray
    """Sums over the harmonics of each tip coordinate (3, `share_width(n_blades)`)."""
    change: FloatArray
    """d or a velocity (n,)."""
    tips: FloatArray
    """The three coordinates of all tips (3, n_blades or more)."""
    waiting: Waiting


class State(NamedTuple):
    """Everything that changes from step to step, and scratch arrays. One model may have several states."""

    buffer: MotionBuffer
    """The motions at steps n - 1 and n, and one to write. Between turns they are in this order."""
    contact: ContactWork
    """Gaps that steps have left, and the contacts of the last step."""
    support: SupportState
    """Forces of uneven supports and of laws of the support, and their works."""
    wear: Wear
    """The liner's worn depth."""
    works: FloatArray
    """Works so far (8,), J, at the indices of `energy_kernels`."""
    scratch: Scratch

    @property
    def motions(self) -> tuple[Motion, Motion, Motion]:
        """Views of the three motions in `buffer`, outside of kernels."""
        before, now, other = (Motion(z, tips, q) for z, tips, q in zip(*self.buffer, strict=True))
        return before, now, other


class Snapshots(NamedTuple):
    """The motion at chosen steps of a turn."""

    steps: IntArray
    """Rising numbers of the steps (snapshots,), from 1 to the steps of a turn."""
    z: FloatArray
    """z at the step before and at the step (snapshots, 2, size of z)."""
    step_gaps: FloatArray
    """The scheme's gaps there (snapshots, 2, n_blades), m."""


@inlined_kernel
def keep_snapshot(snapshots: Snapshots, number: int, before: Motion, now: Motion, work: ContactWork) -> int:
    """Copy z of the motions `before` and `now`, and their gaps, into snapshot `number`. Return the next number.

    The gaps are rows 0 and 1 of `work.step_gaps`: `shift_gaps` must have been called.
    """
    for i in range(now.z.shape[0]):
        snapshots.z[number, 0, i] = before.z[i]
        snapshots.z[number, 1, i] = now.z[i]
    for k in range(snapshots.step_gaps.shape[2]):
        snapshots.step_gaps[number, 0, k] = work.step_gaps[0, k]
        snapshots.step_gaps[number, 1, k] = work.step_gaps[1, k]
    return number + 1
