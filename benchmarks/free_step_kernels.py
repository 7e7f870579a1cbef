"""Free steps alone, to be timed."""

from __future__ import annotations

from rubgen.arrays import FloatArray
from rubgen.jit import allocation_free_kernel
from rubgen.solver.scheme.free_step_kernels import Scheme, free_step


@allocation_free_kernel
def run_free(scheme: Scheme, before: FloatArray, now: FloatArray, after: FloatArray, steps: int) -> None:
    """So many free steps; the three states change places with each."""
    for _ in range(steps):
        free_step(scheme, before, now, after)
        before, now, after = now, after, before
