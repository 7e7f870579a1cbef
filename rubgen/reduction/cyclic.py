"""The disk's rotational symmetry: what one sector of it knows of all others.

A turn Q by one blade pitch moves the disk onto itself, so every matrix X of it commutes with Q. The static shape that a
unit displacement of rim node k causes is that of node 0, turned: Psi_k = Q^k Psi_0 R_k^T (R_k turns the six DoFs of a
node); and a projection V^T X V on such shapes repeats its first block column, P_l,k = R_k P_(l-k),0 R_k^T. Twelve
solves thus stand for 6 + 6 N, whatever the blades are like. Tests: tests/reduction/test_cyclic.py, against the full
path.
"""

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray, IntArray, SparseMatrix
from rubgen.fem.constraints import blade_rotation

FIRST = 12
"""Masters that are solved for: O_d and the rim node of blade 0."""


@dataclass(frozen=True, kw_only=True)
class Turning:
    """Turns of the disk by whole blade pitches, its DoFs O_d first, then six a node.

    `place` (blades, nodes + 1): turned by k pitches, node i comes to where node place[k, i] was. `rotation`
    (blades, 6, 6) is R_k.
    """

    place: IntArray
    rotation: FloatArray

    def copy_columns(self, V: FloatArray) -> None:
        """Fill the columns of V (n, 6 + 6 blades + any) of the rim nodes 1, 2, ... with turned copies of node 0's."""
        first = V[:, 6:FIRST].reshape(-1, 6, 6)
        for k in range(1, len(self.place)):
            R = self.rotation[k]
            turned = R @ first @ R.T
            V.reshape(-1, 6, V.shape[1])[self.place[k], :, 6 * k + 6 : 6 * k + 12] = turned

    def project(self, X: SparseMatrix, V: FloatArray, *, skew: bool = False) -> FloatArray:
        """V^T X V of a symmetric or skew X (n, n), with V (n, 6 + 6 blades + modes) from `copy_columns`."""
        blades, size = len(self.place), V.shape[1]
        modes = slice(6 + 6 * blades, size)
        solved = np.r_[:FIRST, modes]
        P = np.zeros((size, size))
        P[:, solved] = V.T @ (X @ V[:, solved])
        rim = P[6 : modes.start, 6:FIRST].reshape(blades, 6, 6)
        for k in range(1, blades):
            R, columns = self.rotation[k], slice(6 * k + 6, 6 * k + 12)
            P[:6, columns] = R @ P[:6, 6:FIRST] @ R.T
            P[6 : modes.start, columns] = (R @ np.roll(rim, k, axis=0) @ R.T).reshape(-1, 6)
        P[modes, FIRST : modes.start] = (-1.0 if skew else 1.0) * P[FIRST : modes.start, modes].T
        return P


def disk_turning(rings: IntArray, blades: int) -> Turning:
    """Turns of a disk whose nodes stand in rings of `rings` (any,) nodes each, multiples of the number of blades."""
    starts = 1 + np.concatenate([[0], np.cumsum(rings)[:-1]])
    place = np.zeros((blades, 1 + int(rings.sum())), dtype=np.int64)
    for start, count in zip(starts, rings, strict=True):
        on_ring = np.arange(count)
        shift = (count // blades) * np.arange(blades)[:, None]
        place[:, start : start + count] = start + (on_ring + shift) % count
    angles = 2 * np.pi * np.arange(blades) / blades
    return Turning(place=place, rotation=np.stack([blade_rotation(angle) for angle in angles]))
