"""Compute the steady centrifugal displacement of the blade tips, from the full model.

O_d is the disk centre. K, K_sigma, S and f_c are as in `BliskModel`, A = K_sigma - S.
"""

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.fem.blisk import BliskModel, rigid_motions

# In the preset the tips are then right to 1e-10 at 15,000 rev/min and 1e-7 at 30,000.
BASIS_SIZE = 10
# Blades that differ need more: with 2 % of standard deviation 1e-9 at 15,000 rev/min, with 10 % 1e-7.
MISTUNED_BASIS_SIZE = 20


@dataclass(frozen=True, kw_only=True)
class CentrifugalGrowth:
    """The steady displacement in a small basis of m vectors, with the coefficients y: (K + Omega^2 A) y = Omega^2 f.

    K and A are (m, m), f (m,). `tips` (blades, 3, m) are the vectors at the tips. `moment` (2, m) in kg is each
    vector's int rho (u_x, u_y) dV, by which it shifts the centre of mass. The tip of a missing blade does not grow.
    """

    K: FloatArray
    A: FloatArray
    f: FloatArray
    tips: FloatArray
    moment: FloatArray
    missing: FloatArray
    """First moment (2,) in kg m of the blisk at rest, which blades that are missing leave; 0 where none is."""

    def at(self, speed: float) -> FloatArray:
        """Return the tips' displacement (blades, 3) in m along the blades' axes at `speed` in rad/s."""
        displacement: FloatArray = self.tips @ self._solve(speed)
        return displacement

    def unbalance(self, speed: float) -> FloatArray:
        """Return the unbalance (2,) in kg m along x, y from uneven growth, at `speed` in rad/s; 0 for equal blades."""
        U: FloatArray = self.moment @ self._solve(speed)
        return U

    def _solve(self, speed: float) -> FloatArray:
        return np.asarray(np.linalg.solve(self.K + speed**2 * self.A, speed**2 * self.f), dtype=np.float64)


def centrifugal_growth(model: BliskModel) -> CentrifugalGrowth:
    """Solve (K + Omega^2 (K_sigma - S)) u = Omega^2 f_c for the steady displacement at any speed, in a small basis.

    Galerkin's method in the Krylov space of K^-1 A and K^-1 f_c. K is on its axial, tilt and torsion springs with O_d
    fixed laterally, because a symmetric load does not move O_d. Equal to the direct solution to 1e-9 of its size at the
    preset's top speed: tests/reduction/test_reduced_model.py. Mistuned blades grow unevenly, which loads O_d with
    Omega^2 `unbalance`. Missing blades load it with Omega^2 `missing`. O_d does not move under these loads in u: the
    reduced model applies them.
    """
    count = model.count
    whole = model.present.size == count
    equal = whole and bool(np.ptp(model.blade_stiffness) == 0)
    K, A = model.fixed_centre.K, model.K_sigma - model.S
    basis = np.zeros((len(model.f_c), 0))
    vector = model.fixed_centre.solve(model.f_c)
    for _ in range(BASIS_SIZE if equal else MISTUNED_BASIS_SIZE):
        # Twice is enough: Gram-Schmidt in the inner product of K.
        for _ in range(2):
            vector = vector - basis @ (basis.T @ (K @ vector))
        vector = vector / np.sqrt(vector @ (K @ vector))
        basis = np.column_stack([basis, vector])
        vector = model.fixed_centre.solve(A @ vector)
    shifts = rigid_motions(model)[:, :2]
    moment = (model.S @ shifts).T @ basis
    tips = np.zeros((count, 3, basis.shape[1]))
    tips[model.present] = basis[model.tips[:, :3]]
    return CentrifugalGrowth(
        K=basis.T @ (K @ basis),
        A=basis.T @ (A @ basis),
        f=basis.T @ model.f_c,
        tips=tips,
        # Exactly 0 by symmetry: rounding must not make an unbalance.
        moment=np.zeros_like(moment) if equal else moment,
        missing=np.zeros(2) if whole else shifts.T @ model.f_c,
    )
