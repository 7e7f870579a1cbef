"""The step of the scheme without contact, in blocks."""

from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.jit import inlined_kernel
from rubgen.linalg.lanes_kernels import set_two_lines


class Scheme(NamedTuple):
    """The step without contact, q* = now q_n + before q_n-1 + constant, and A^-1, all in blocks."""

    lines: IntArray
    """Lines of `now`, `before` and `inverse`."""
    now: FloatArray
    """Matrix of q_n."""
    before: FloatArray
    """Matrix of q_n-1."""
    constant: FloatArray
    """A^-1 times the unbalance force, in z."""
    inverse: FloatArray
    """A^-1."""


@inlined_kernel
def free_step(scheme: Scheme, before: FloatArray, now: FloatArray, after: FloatArray) -> None:
    """Write q*, the coordinates at step n + 1 without contact, in z into `after`.

    `before` and `now` are z at n - 1 and n.
    """
    set_two_lines(scheme.lines, scheme.now, scheme.before, now, before, scheme.constant, after)
