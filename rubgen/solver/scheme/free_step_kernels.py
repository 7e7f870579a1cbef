"""The step of the scheme without contact, in blocks."""

from __future__ import annotations

from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.jit import inlined_kernel
from rubgen.linalg.lanes_kernels import set_two_lines


class Scheme(NamedTuple):
    """The free step q* = now q_n + before q_n-1 + constant, and A^-1, whose entries share the lines of both."""

    lines: IntArray
    now: FloatArray
    before: FloatArray
    constant: FloatArray
    inverse: FloatArray


@inlined_kernel
def free_step(scheme: Scheme, before: FloatArray, now: FloatArray, after: FloatArray) -> None:
    """q* in z."""
    set_two_lines(scheme.lines, scheme.now, scheme.before, now, before, scheme.constant, after)
