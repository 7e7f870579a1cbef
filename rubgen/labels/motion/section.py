"""Scale the Poincare section of blisk and casing, and test whether the motion has the symmetry of the lobes.

O_d is the disk centre.
"""

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.labels.motion.clusters import EXCURSION
from rubgen.solver.response import Response

REST_ENERGY = 5e-12
"""A casing with less energy than this, in J, stands still: 1 nm of 7 kg at 180 Hz."""


def blisk_points(response: Response) -> FloatArray:
    """Return the section of the blisk (turns, groups, 4), divided by the rms orbital speed of O_d.

    Group 0 is O_d: Omega x, Omega y, v_x, v_y. Groups 1 .. are the tips: Omega times their three displacements, then 0.
    The absolute velocity of O_d, v + Omega e_z x u, has the orbit's size even where O_d rests in the turning frame.
    """
    return blisk_states(response, response.section_q, response.section_v)


def blisk_states(response: Response, q: FloatArray, v: FloatArray) -> FloatArray:
    """Return states q, v (states, n) as points of the blisk (states, groups, 4), scaled as in `blisk_points`."""
    speed, centre = response.speed, 3 * response.n_blades
    points = np.zeros((len(q), response.n_blades + 1, 4))
    points[:, 0] = np.stack([speed * q[:, centre], speed * q[:, centre + 1], v[:, centre], v[:, centre + 1]], axis=1)
    points[:, 1:, :3] = speed * q[:, :centre].reshape(len(q), response.n_blades, 3)
    return np.asarray(points / _orbital_speed(response), dtype=np.float64)


def _orbital_speed(response: Response) -> float:
    q, v, speed, centre = response.section_q, response.section_v, response.speed, 3 * response.n_blades
    x, y, v_x, v_y = q[:, centre], q[:, centre + 1], v[:, centre], v[:, centre + 1]
    return float(np.sqrt(np.mean((v_x - speed * y) ** 2 + (v_y + speed * x) ** 2)))


def casing_points(response: Response) -> FloatArray:
    """Return the section of the casing (turns, 1, 2 modes), divided by its rms norm.

    Each point has Omega times the modal displacements, then the modal velocities. Between two touches the casing swings
    freely about its shape at rest, so its displacement from this shape is motion. Touches that end do not offset the
    section; only a touch that never ends would. Points of a casing that does not move at all are NaN.
    """
    return casing_states(response, response.section_q, response.section_v)


def casing_states(response: Response, q: FloatArray, v: FloatArray) -> FloatArray:
    """Return states q, v (states, n) as points of the casing (states, 1, 2 modes), scaled as in `casing_points`."""
    size = np.sqrt(np.mean(np.sum(_casing(response, response.section_q, response.section_v) ** 2, axis=1)))
    return np.asarray(_casing(response, q, v)[:, None, :] / size, dtype=np.float64)


def _casing(response: Response, q: FloatArray, v: FloatArray) -> FloatArray:
    modes = slice(q.shape[1] - response.n_casing, None)
    return np.concatenate([response.speed * q[:, modes], v[:, modes]], axis=1)


def casing_rests(response: Response) -> bool:
    """Return whether the casing's energy stays below REST_ENERGY in the second half of the record.

    The energy is the sum over its modes of (v^2 + Omega^2 q^2) / 2 in the section.
    """
    half = response.section_q.shape[0] // 2
    states = _casing(response, response.section_q[half:], response.section_v[half:])
    return bool(np.sum(states**2, axis=1).max() / 2 < REST_ENERGY)


def asymmetry(response: Response) -> float | None:
    """Return how far the motion is from the symmetry of the N lobes: 0 for symmetric motion.

    The states after 1/N, 2/N, ... of the last turn (`Response.symmetry_states`) are compared with the state at its end.
    In each state the casing is turned back by the angle by which the blisk has turned. The result is the largest
    distance of disk centre, any tip, and casing. The casing is left out if it rests. States are scaled as in
    `blisk_points` and `casing_points`, so that distances are shares of the size of the motion.

    None with fewer than two states: at a changing speed, and if N is 1 (`lobes_of`).
    """
    q, v = response.symmetry_states[:, 0], response.symmetry_states[:, 1]
    if len(q) < 2:
        return None
    parts = [blisk_states(response, q, v)]
    if not casing_rests(response):
        parts.append(casing_states(response, q, v))
    return max(float(np.linalg.norm(points - points[-1], axis=2).max()) for points in parts)


def is_symmetric(response: Response) -> bool | None:
    """Return whether the motion has the symmetry of the lobes: `asymmetry` is at most 3 %. None where that is None."""
    found = asymmetry(response)
    return None if found is None else found <= EXCURSION
