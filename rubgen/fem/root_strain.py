"""Strain at the root of a blade from the displacements of its first element."""

from __future__ import annotations

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.fem.beam import BeamMatrices
from rubgen.fem.beam_sections import blade_sections, section_stiffness
from rubgen.machine import BladeRow


def root_strain_row(blades: BladeRow, root_radius: float, beam: BeamMatrices) -> FloatArray:
    """Spanwise strain (12,) per displacement of a blade's first two nodes, at the root's mid-chord fibre.

    The fibre lies on the face to which the thickness normal n = (-sin a, cos a) in (y, z) points, half the thickness h
    from the centre line: eps + (h / 2) (n_z th_y' - n_y th_z'). The section strains are D^-1 F, F the section forces at
    the root, which are minus the nodal forces of the first element: exact for loads at the nodes. A blade with another
    stiffness has the same row. Test: tests/reduction/test_root_strain.py.
    """
    sections = blade_sections(blades, root_radius, np.zeros(1))
    strains = -np.linalg.solve(section_stiffness(blades, sections)[0], beam.K[:6, :12])
    angle = np.deg2rad(blades.root_angle_deg)
    half = blades.root_thickness_m / 2
    return np.asarray(strains[0] + half * (np.cos(angle) * strains[4] + np.sin(angle) * strains[5]))
