"""The state of a run, which every step changes, and the room in which a step works."""

from typing import NamedTuple

from rubgen.arrays import FloatArray
from rubgen.contact.contact_kernels import ContactWork
from rubgen.contact.liner_kernels import Wear
from rubgen.solver.scheme.motion_kernels import Motion
from rubgen.solver.supports.support_kernels import SupportState


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


class Scratch(NamedTuple):
    """Arrays that no step reads before it has written them."""

    free: Motion
    """The free motion q*, to go back to."""
    z_change: FloatArray
    """d in z."""
    z_force: FloatArray
    """A force in z."""
    share: FloatArray
    """Sums over the harmonics of each tip coordinate (3, any)."""
    change: FloatArray
    """d or a velocity (n,)."""
    tips: FloatArray
    """The three coordinates of all tips (3, width)."""


class State(NamedTuple):
    """All that changes from step to step, and scratch. One model may have several states."""

    motions: tuple[Motion, Motion, Motion]
    """The motions at steps n - 1 and n, and one to write."""
    contact: ContactWork
    """Gaps that steps have left, and the contacts of the last step."""
    support: SupportState
    """Forces of uneven supports and of laws of the support, and their works."""
    wear: Wear
    """The liner's worn depth."""
    works: FloatArray
    """Works so far (8,), J, at the places of `energy_kernels`."""
    scratch: Scratch
