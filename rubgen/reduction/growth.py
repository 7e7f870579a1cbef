"""Steady centrifugal displacement of the blade tips, from the full model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.fem.blisk import BliskModel

# In the preset the tips are then right to 1e-10 at 15,000 rev/min and 1e-7 at 30,000.
BASIS_SIZE = 10


@dataclass(frozen=True, kw_only=True)
class CentrifugalGrowth:
    """(K + Omega^2 A) y = Omega^2 f in a small basis: K, A (m, m), f (m,); `tips` (blades, 3, m) of its vectors."""

    K: FloatArray
    A: FloatArray
    f: FloatArray
    tips: FloatArray

    def at(self, speed: float) -> FloatArray:
        """Tip displacement (blades, 3) in m along the blades' axes at `speed` in rad/s."""
        y = np.linalg.solve(self.K + speed**2 * self.A, speed**2 * self.f)
        displacement: FloatArray = self.tips @ y
        return displacement


def centrifugal_growth(model: BliskModel) -> CentrifugalGrowth:
    """Galerkin solution of (K + Omega^2 (K_sigma - S)) u = Omega^2 f_c in the Krylov space of K^-1 A and K^-1 f_c.

    K is on its axial, tilt and torsion springs with O_d held laterally, where a symmetric load leaves it. Equal to the
    direct solution to 1e-9 of its size at the preset's top speed: tests/reduction/test_reduced_model.py.
    """
    K, A = model.held.K, model.K_sigma - model.S
    basis = np.zeros((len(model.f_c), 0))
    vector = model.held.solve(model.f_c)
    for _ in range(BASIS_SIZE):
        # Twice is enough: Gram-Schmidt in the inner product of K.
        for _ in range(2):
            vector = vector - basis @ (basis.T @ (K @ vector))
        vector = vector / np.sqrt(vector @ (K @ vector))
        basis = np.column_stack([basis, vector])
        vector = model.held.solve(A @ vector)
    return CentrifugalGrowth(
        K=basis.T @ (K @ basis),
        A=basis.T @ (A @ basis),
        f=basis.T @ model.f_c,
        tips=basis[model.tips[:, :3]],
    )
