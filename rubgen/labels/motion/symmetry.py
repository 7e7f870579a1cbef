"""Whether a motion has the symmetry of the casing: q(t + T/N) = q(t), seen in the turning frame."""

import numpy as np

from rubgen.labels.motion.clusters import EXCURSION
from rubgen.labels.motion.section import blisk_states, casing_rests, casing_states
from rubgen.solver.response import Response


def asymmetry(response: Response) -> float | None:
    """Largest distance between the states after each Nth of the last turn, over the part's motion; None without lobes.

    For the blisk it is the largest distance of disk centre and tips, as in the clusters. The casing is turned back by
    the angle that the blisk turned.
    """
    q, v = response.symmetry_states[:, 0], response.symmetry_states[:, 1]
    if len(q) < 2:
        return None
    parts = [blisk_states(response, q, v)]
    if not casing_rests(response):
        parts.append(casing_states(response, q, v))
    return max(float(np.linalg.norm(points - points[-1], axis=2).max()) for points in parts)


def is_symmetric(response: Response) -> bool | None:
    """Whether the states differ by at most EXCURSION, 3 %; None without lobes."""
    found = asymmetry(response)
    return None if found is None else found <= EXCURSION
