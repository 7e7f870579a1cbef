"""Find the blocks into which the matrices of systems decompose."""

import numpy as np

from rubgen.linalg.blocks import Blocks, find_blocks
from rubgen.reduction.model import SpinningSystem


def system_blocks(*systems: SpinningSystem) -> Blocks:
    """Find the blocks that the matrices M, C and K of all systems share.

    All systems have the same coordinates q. The tips' coordinates are first changed to harmonics over the blades,
    q = T y. The blocks are those of y, not of q; `Blocks` has T and the place of each y in the stored order z. No block
    has coordinates of both blisk and casing. See `find_blocks`.

    Raises ValueError where M, C or K couple blisk and casing.
    """
    start = systems[0].casing_start
    matrices = [matrix for system in systems for matrix in (system.M, system.C, system.K)]
    for matrix in matrices:
        if np.any(matrix[:start, start:]) or np.any(matrix[start:, :start]):
            raise ValueError("M, C and K must not couple blisk and casing: contact alone does")
    return find_blocks(matrices, systems[0].n_blades)
