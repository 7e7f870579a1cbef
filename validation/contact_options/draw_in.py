"""How far the tips of a run were bent, and what they would have drawn back."""

from __future__ import annotations

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.solver import Response


def deflections(response: Response) -> FloatArray:
    """Tangential and axial displacements (any, 2) of tips, less the disk centre's motion, in m.

    Of all blades at all sections and, where there is one, in the frames of the replay track.
    """
    q = response.section_q if response.track is None else np.concatenate([response.section_q, response.track.q])
    n, centre = response.n_blades, 3 * response.n_blades
    angle = 2 * np.pi * np.arange(n) / n
    tips = q[:, :centre].reshape(-1, n, 3)
    disk = q[:, centre + 1, None] * np.cos(angle) - q[:, centre, None] * np.sin(angle)
    return np.stack([tips[..., 1] - disk, tips[..., 2]], axis=-1).reshape(-1, 2)


def draw_in(Q: FloatArray, deflected: FloatArray) -> FloatArray:
    """What tips draw back, (any,) in m, for deflections (any, 2)."""
    return np.asarray(np.einsum("ki,ij,kj->k", deflected, Q, deflected))
