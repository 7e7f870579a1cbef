"""The liner at the end of a run."""

import numpy as np

from rubgen.contact.liner_kernels import REMOVED, Liner, Wear, worn_depth
from rubgen.solver.response import WornLiner


def worn_liner(liner: Liner, wear: Wear) -> WornLiner | None:
    """Return the worn profile of a liner, and the volume removed; None without a liner."""
    if liner.bins == 0:
        return None
    angle = 2 * np.pi * np.arange(liner.bins) / liner.bins
    return WornLiner(
        angle=angle,
        depth=np.array([worn_depth(wear.depth, psi)[0] for psi in angle]),
        volume=float(liner.area * wear.depth.sum()),
        removed=float(wear.sums[REMOVED]),
    )
