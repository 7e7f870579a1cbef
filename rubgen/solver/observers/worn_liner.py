"""What a run leaves of a liner."""

from __future__ import annotations

import numpy as np

from rubgen.contact.geometry_kernels import Surface
from rubgen.contact.liner_kernels import REMOVED, worn_depth
from rubgen.solver.response import WornLiner


def worn_liner(surface: Surface) -> WornLiner | None:
    """The worn profile of a surface's liner at its bins, and the volume removed; None without a liner."""
    liner = surface.liner
    bins = len(liner.depth)
    if bins == 0:
        return None
    angle = 2 * np.pi * np.arange(bins) / bins
    return WornLiner(
        angle=angle,
        depth=np.array([worn_depth(liner.depth, psi)[0] for psi in angle]),
        volume=float(liner.area * liner.depth.sum()),
        removed=float(liner.book[REMOVED]),
    )
