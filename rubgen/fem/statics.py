"""Sparse direct solves with the full blisk."""

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import SuperLU, splu

from rubgen.arrays import FloatArray, SparseMatrix
from rubgen.machine import DiskSupport


def factorize(K: SparseMatrix) -> SuperLU:
    """LU factors of a symmetric positive definite stiffness, ordered for symmetric matrices, without pivoting."""
    return splu(sp.csc_array(K), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


def support_stiffness(support: DiskSupport) -> FloatArray:
    """Spring constants (6,) of O_d: x, y, z in N/m, rotations about x, y, z in N m/rad."""
    lateral, tilt = support.lateral_stiffness_n_per_m, support.tilt_stiffness_nm_per_rad
    axial, torsion = support.axial_stiffness_n_per_m, support.torsion_stiffness_nm_per_rad
    return np.array([lateral, lateral, axial, tilt, tilt, torsion])


def on_springs(K: SparseMatrix, stiffness: FloatArray) -> SparseMatrix:
    """K with the springs of `stiffness` (6,) on its first six DoFs, those of O_d."""
    diagonal = np.zeros(K.shape[0])
    diagonal[:6] = stiffness
    return (K + sp.diags_array(diagonal)).tocsr()


class HeldStiffness:
    """K on its axial, tilt and torsion springs, with O_d x and y held at zero: factorised once.

    By symmetry the centrifugal load of two or more equal blades does not push O_d sideways, so the steady state is the
    same for any lateral stiffness.
    """

    def __init__(self, K: SparseMatrix, support: DiskSupport) -> None:
        self.K = on_springs(K, support_stiffness(support))
        self._factor = factorize(self.K[2:, 2:])

    def solve(self, load: FloatArray) -> FloatArray:
        """Displacement (n,) under `load` (n,)."""
        return np.concatenate([np.zeros(2), self._factor.solve(load[2:])])
