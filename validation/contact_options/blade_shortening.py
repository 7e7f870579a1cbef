"""How much a bent blade draws back its tip, which linear elements leave out.

A bent beam of unchanged length is shorter along its axis by half the integral of v'^2 + w'^2: second order in its
deflection.
"""

from __future__ import annotations

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.fem.beam import blade_matrices
from rubgen.machine import BladeRow


def draw_in_matrix(blades: BladeRow, root_radius: float) -> tuple[FloatArray, FloatArray]:
    """Q (2, 2) in 1/m, and the tip's compliance (2, 2) in m/N, both over d = (tangential, axial) deflection of the tip.

    A tip that forces bend by d draws back by d^T Q d, Q = 1/2 int v'^T v' dx of the clamped blade's static shapes under
    tangential and axial forces; a uniform beam has 3 / (5 L) (Euler-Bernoulli). Faster modes bend more for the same
    deflection of the tip.
    """
    K = blade_matrices(blades, root_radius).K
    sideways = [len(K) - 6 + 1, len(K) - 6 + 2]
    shapes = np.zeros((len(K), 2))
    shapes[6:] = np.linalg.solve(K[6:, 6:], np.eye(len(K))[6:, sideways])
    compliance = shapes[sideways]
    lateral = (shapes @ np.linalg.inv(compliance)).reshape(-1, 6, 2)[:, 1:3]
    step = blades.length_m / blades.elements
    slopes = np.diff(lateral, axis=0) / step
    return np.asarray(0.5 * step * np.einsum("eci,ecj->ij", slopes, slopes)), (compliance + compliance.T) / 2


def soft_draw_in(blades: BladeRow, root_radius: float) -> float:
    """Draw-in where the blade is softest, over the square of the tip's deflection, in 1/m."""
    Q, compliance = draw_in_matrix(blades, root_radius)
    direction = np.linalg.eigh(compliance)[1][:, -1]
    return float(direction @ Q @ direction)
