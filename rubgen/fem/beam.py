"""Pre-twisted, tapered Timoshenko beams: one blade in its own axes.

Axes: x radial (along the blade), y tangential (e_z x e_x), z along the axis of rotation. Six DoF a node:
u_x, u_y, u_z, th_x, th_y, th_z. A point s = (0, y, z) of the cross-section moves by u + th x s.
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import leggauss

from rubgen.arrays import FloatArray
from rubgen.fem.cross_sections import (
    cross_section_coriolis,
    cross_section_load,
    cross_section_mass,
    cross_section_pull,
    cross_section_second_order,
    cross_section_spin,
    cross_section_stiffness,
    cross_sections,
)
from rubgen.machine.machine import BladeRow

# Eight points integrate the polynomials of the taper exactly; the twist within one element is smooth besides.
GAUSS_POINTS = 8


@dataclass(frozen=True, kw_only=True)
class BeamMatrices:
    """The matrices of one blade: dense (n, n), with load (n,), n = 6 (elements + 1), nodes from root to tip.

    M is mass, K elastic stiffness, G Coriolis (skew), S spin softening, K_sigma stiffness from centrifugal stress, f_c
    centrifugal load at 1 rad/s. The blade's share of the equation of motion in the turning frame at spin speed Omega is
    M q'' + 2 Omega G q' + (K + Omega^2 (K_sigma - S)) q = Omega^2 f_c. The rest of the machine carries
    the axial force at the root; its geometric stiffness belongs there.
    """

    M: FloatArray
    K: FloatArray
    G: FloatArray
    S: FloatArray
    K_sigma: FloatArray
    f_c: FloatArray


def blade_matrices(blades: BladeRow, root_radius: float) -> BeamMatrices:
    """Assemble the matrices of one blade from two-node beam elements with exact statics.

    `root_radius` is the radius of the root in m.

    Stiffness: the internal forces of an element in equilibrium are b(x) F with F the forces at its outer end. With the
    cross-section stiffness D the flexibility is f = int b^T D^-1 b dx. K = Gamma^T f^-1 Gamma, with Gamma q the outer
    node's motion relative to a rigid body on the inner node. The displacement of this element is the shape function
    N(x) of every other matrix. Statics are exact at the nodes for any taper and twist, without locking. Frequencies
    converge with order 4 where bending dominates, with order 2 where shear, torsion or extension does.

    M = int rho N^T N, G = int rho N^T (e_z x N), S = int rho N^T (1 - e_z e_z^T) N, f_c = int rho N^T r_perp over the
    volume, so with rotary inertia. f_c contains the propeller moment -rho I_yz about x. K_sigma, at 1 rad/s, is twice
    the energy per length of P (u_y'^2 + u_z'^2) / 2 + P I_p / A th_x'^2 / 2 + E2, P(x) = int_x^L rho A r dr, where E2 =
    rho [I_y2 (th_x^2 + th_z^2) - I_yz th_y th_z] / 2 is minus the work of the centrifugal load on the second-order
    displacement th x (th x s) / 2 of the cross-section.

    Left out: mistuning, warping, the coupling of extension with twist, the geometric stiffness of the steady twisting
    moment. Checked against closed forms, shooting and published rotating beams in tests/fem/test_beam*.py.
    """
    elements = blades.elements
    step = blades.length_m / elements
    starts: FloatArray = step * np.arange(elements, dtype=np.float64)
    shape, strain = _shape_functions(blades, root_radius, starts, step)
    points, weights = _gauss(step)
    sections = cross_sections(blades, root_radius, starts[:, None] + points)
    rho = blades.material.density_kg_per_m3
    radius = root_radius + starts[:, None] + points
    gradient = strain.copy()
    gradient[:, :, 1, :] += shape[:, :, 5, :]  # u_y' = gamma_y + th_z
    gradient[:, :, 2, :] -= shape[:, :, 4, :]  # u_z' = gamma_z - th_y

    def integral(fields: FloatArray, section: FloatArray) -> FloatArray:
        weighted = weights[:, None, None] * (section @ fields)
        blocks: FloatArray = np.sum(np.swapaxes(fields, -1, -2) @ weighted, axis=1)
        return _assemble(blocks)

    load = rho * np.einsum("g,egif,egi->ef", weights, shape, cross_section_load(sections, radius))
    return BeamMatrices(
        M=symmetric(integral(shape, rho * cross_section_mass(sections))),
        K=symmetric(integral(strain, cross_section_stiffness(blades, sections))),
        G=skew(integral(shape, rho * cross_section_coriolis(sections))),
        S=symmetric(integral(shape, rho * cross_section_spin(sections))),
        K_sigma=symmetric(
            integral(gradient, cross_section_pull(sections))
            + integral(shape, rho * cross_section_second_order(sections))
        ),
        f_c=_assemble_vector(load),
    )


def _gauss(length: float | FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return Gauss points and weights on 0..length."""
    points, weights = leggauss(GAUSS_POINTS)
    scale: FloatArray = np.asarray(length, dtype=np.float64)[..., None] / 2
    return scale * (points + 1), scale * weights


def _shape_functions(
    blades: BladeRow, root_radius: float, starts: FloatArray, step: float
) -> tuple[FloatArray, FloatArray]:
    """Return N(x) and generalised strains at Gauss points (element, point, 6, 12), from the element's exact statics."""

    def flexibility(ends: FloatArray) -> FloatArray:
        """int_0^end b_end^T D^-1 b ds: motion at `end` by unit forces at the element's outer end."""
        inner, weights = _gauss(ends)
        sections = cross_sections(blades, root_radius, starts[:, None, None] + inner)
        compliance = np.linalg.inv(cross_section_stiffness(blades, sections))
        at_end = np.swapaxes(_equilibrium(ends[:, None] - inner), -1, -2)
        integrand: FloatArray = weights[..., None, None] * (at_end @ compliance @ _equilibrium(step - inner))
        motion: FloatArray = integrand.sum(axis=2)
        return motion

    points, _ = _gauss(step)
    inverse = np.linalg.inv(flexibility(np.array([step])))
    relative = np.concatenate([-_rigid(np.array(step)), np.eye(6)], axis=1)
    end_forces = inverse @ relative
    rigid = np.concatenate([_rigid(points), np.zeros((points.size, 6, 6))], axis=-1)
    shape: FloatArray = rigid + flexibility(points) @ end_forces
    sections = cross_sections(blades, root_radius, starts[:, None] + points)
    compliance = np.linalg.inv(cross_section_stiffness(blades, sections))
    strain: FloatArray = compliance @ _equilibrium(step - points) @ end_forces
    return shape, strain


def _equilibrium(arm: FloatArray) -> FloatArray:
    """Return b: internal forces (N, V_y, V_z, M_x, M_y, M_z) of unit forces that act a distance `arm` further out."""
    b = np.zeros((*arm.shape, 6, 6))
    b[..., range(6), range(6)] = 1.0
    b[..., 4, 2], b[..., 5, 1] = -arm, arm
    return b


def _rigid(x: FloatArray) -> FloatArray:
    """Return the motion at x of a rigid body on the node at 0: u + th x (x e_x)."""
    return np.swapaxes(_equilibrium(x), -1, -2)


def _assemble(blocks: FloatArray) -> FloatArray:
    n = 6 * (blocks.shape[0] + 1)
    matrix = np.zeros((n, n))
    for e, block in enumerate(blocks):
        matrix[6 * e : 6 * e + 12, 6 * e : 6 * e + 12] += block
    return matrix


def _assemble_vector(blocks: FloatArray) -> FloatArray:
    vector = np.zeros(6 * (blocks.shape[0] + 1))
    for e, block in enumerate(blocks):
        vector[6 * e : 6 * e + 12] += block
    return vector


def symmetric(matrix: FloatArray) -> FloatArray:
    """Return the symmetric part (A + A^T) / 2, to remove rounding errors where A is symmetric by its formula."""
    return np.ascontiguousarray((matrix + matrix.T) / 2)


def skew(matrix: FloatArray) -> FloatArray:
    """Return the skew part (A - A^T) / 2, to remove rounding errors where A is skew by its formula."""
    return np.ascontiguousarray((matrix - matrix.T) / 2)


def root_strain_row(blades: BladeRow, root_radius: float, beam: BeamMatrices) -> FloatArray:
    """Return the row (12,) that multiplies the displacements of a blade's first two nodes to the strain at its root.

    The displacements are along the blade's own axes. It is the spanwise strain of the mid-chord fibre on the face to
    which the thickness normal n = (-sin a, cos a) in (y, z) points, half the thickness h from the centre line: eps + (h
    / 2) (n_z th_y' - n_y th_z'). The generalised strains are D^-1 F. The internal forces F at the root are minus the
    nodal forces of the first element, which is exact for loads at the nodes. The row is the same for a mistuned blade.
    `root_radius` is in m. Test: tests/reduction/test_root_strain.py.
    """
    sections = cross_sections(blades, root_radius, np.zeros(1))
    strains = -np.linalg.solve(cross_section_stiffness(blades, sections)[0], beam.K[:6, :12])
    angle = np.deg2rad(blades.root_angle_deg)
    half = blades.root_thickness_m / 2
    return np.asarray(strains[0] + half * (np.cos(angle) * strains[4] + np.sin(angle) * strains[5]))


def static_root_strain(
    blades: BladeRow, root_radius: float, beam: BeamMatrices, *, speed: float, stiffness: float = 1.0
) -> tuple[FloatArray, FloatArray]:
    """Return a blade's root strain per displacement of its tip (3,) and of its root (6,), without inertia.

    The strain is defined as in `root_strain_row`. The displacements lie along the blade's axes: u of the tip in m, u in
    m and th in rad of the root. Between tip and root the blade has the shape of least energy under K + Omega^2
    (K_sigma - S). At rest it is the cubic of a tip load; at speed it is flatter, with more curvature near the root.

    - blades: the blade row.
    - root_radius: radius of the root, m.
    - beam: matrices of one blade.
    - speed: Omega, rad/s.
    - stiffness: factor of K of a mistuned blade.
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
