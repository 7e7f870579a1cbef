"""Strain at the root of a blade from the displacements of its first element."""

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.fem.beam import BeamMatrices
from rubgen.fem.cross_sections import cross_section_stiffness, cross_sections
from rubgen.machine import BladeRow


def root_strain_row(blades: BladeRow, root_radius: float, beam: BeamMatrices) -> FloatArray:
    """Spanwise strain (12,) per displacement of a blade's first two nodes, at the root's mid-chord fibre.

    The fibre lies on the face to which the thickness normal n = (-sin a, cos a) in (y, z) points, half the thickness h
    from the centre line: eps + (h / 2) (n_z th_y' - n_y th_z'). The generalised strains are D^-1 F. The internal forces
    F at the root are minus the nodal forces of the first element, which is exact for loads at the nodes. A blade with
    another stiffness has the same row. Test: tests/reduction/test_root_strain.py.
    """
    sections = cross_sections(blades, root_radius, np.zeros(1))
    strains = -np.linalg.solve(cross_section_stiffness(blades, sections)[0], beam.K[:6, :12])
    angle = np.deg2rad(blades.root_angle_deg)
    half = blades.root_thickness_m / 2
    return np.asarray(strains[0] + half * (np.cos(angle) * strains[4] + np.sin(angle) * strains[5]))


def held_root_strain(
    blades: BladeRow, root_radius: float, beam: BeamMatrices, *, speed: float, stiffness: float = 1.0
) -> tuple[FloatArray, FloatArray]:
    """Strain of `root_strain_row` per displacement of the tip (3,) and of the root (6,), inertia apart, at `speed`.

    Between them the blade takes the shape of least energy under K + Omega^2 (K_sigma - S), K times `stiffness`: at rest
    the cubic of a tip load, at speed flatter with more curvature near the root.
    """
    n = len(beam.f_c)
    K = stiffness * beam.K + speed**2 * (beam.K_sigma - beam.S)
    given = np.concatenate([np.arange(n - 6, n - 3), np.arange(6)])
    free = np.setdiff1d(np.arange(n), given)
    shape = np.zeros((n, given.size))
    shape[given, np.arange(given.size)] = 1.0
    shape[free] = -np.linalg.solve(K[np.ix_(free, free)], K[np.ix_(free, given)])
    strain: FloatArray = root_strain_row(blades, root_radius, beam) @ shape[:12]
    return strain[:3], strain[3:]
