"""Pre-twisted, tapered Timoshenko beams: one blade in its own axes.

Axes: x radial (along the blade), y tangential (e_z x e_x), z along the axis of rotation. Six DoF a node:
u_x, u_y, u_z, th_x, th_y, th_z. A point s = (0, y, z) of the section moves by u + th x s.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial
from numpy.polynomial.legendre import leggauss

from rubgen.arrays import FloatArray
from rubgen.machine.machine import BladeRow

# Eight points integrate the polynomials of the taper exactly; the twist within one element is smooth besides.
GAUSS_POINTS = 8


@dataclass(frozen=True, kw_only=True)
class BeamMatrices:
    """One blade: dense (n, n) matrices and (n,) load, n = 6 (elements + 1), nodes from root to tip.

    The blade's share of the equation of motion in the turning frame at spin speed Omega is
    M q'' + 2 Omega G q' + (K + Omega^2 (K_sigma - S)) q = Omega^2 f_c. `root_pull` is the axial force at the root at
    1 rad/s, in N s^2: the rest of the machine carries it, and its geometric stiffness is theirs.
    """

    M: FloatArray
    K: FloatArray
    G: FloatArray
    S: FloatArray
    K_sigma: FloatArray
    f_c: FloatArray
    root_pull: float


@dataclass(frozen=True, kw_only=True)
class BladeSections:
    """The rectangular sections of a blade at distances x (any shape) from the root.

    `area` = int dA, `yy` = int y^2 dA, `zz` = int z^2 dA, `yz` = int y z dA, `torsion` the Saint-Venant constant,
    `pull` the axial force of all mass outboard at 1 rad/s. Each has the shape of x.
    """

    area: FloatArray
    yy: FloatArray
    zz: FloatArray
    yz: FloatArray
    torsion: FloatArray
    pull: FloatArray


def cowper_shear_coefficient(poisson_ratio: float) -> float:
    """kappa = 10 (1 + nu) / (12 + 11 nu) of a rectangle (Cowper 1966, J. Appl. Mech. 33)."""
    return 10 * (1 + poisson_ratio) / (12 + 11 * poisson_ratio)


def rectangle_torsion_constant(long_side: FloatArray, short_side: FloatArray) -> FloatArray:
    """Saint-Venant torsion constant of a rectangle, in m^4.

    J = c h^3 / 3 (1 - 192 h / (pi^5 c) sum_{n odd} tanh(n pi c / (2 h)) / n^5) (Timoshenko and Goodier, art. 109).
    The series is the same function for c < h, where it only converges to fewer digits.
    """
    ratio = short_side / long_side
    series = sum(np.tanh(n * np.pi / (2 * ratio)) / n**5 for n in range(1, 40, 2))
    constant: FloatArray = long_side * short_side**3 / 3 * (1 - 192 * ratio / np.pi**5 * series)
    return constant


def blade_sections(blades: BladeRow, root_radius: float, x: FloatArray) -> BladeSections:
    """Section properties at distances `x` (m) from the root, which stands at `root_radius` (m).

    Chord, thickness and angle are linear in x. The chord points along cos(angle) e_y + sin(angle) e_z, the thickness
    normal along -sin(angle) e_y + cos(angle) e_z: at angle 0 the blade lies flat in the plane of the disk.
    """
    chord = _linear(blades.root_chord_m, blades.tip_chord_m, blades.length_m)
    thickness = _linear(blades.root_thickness_m, blades.tip_thickness_m, blades.length_m)
    angle = np.deg2rad(_linear(blades.root_angle_deg, blades.tip_angle_deg, blades.length_m)(x))
    c, h = chord(x), thickness(x)
    along_chord, along_normal = h * c**3 / 12, c * h**3 / 12
    cos, sin = np.cos(angle), np.sin(angle)
    inboard = (chord * thickness * Polynomial([root_radius, 1.0])).integ()
    return BladeSections(
        area=c * h,
        yy=along_chord * cos**2 + along_normal * sin**2,
        zz=along_chord * sin**2 + along_normal * cos**2,
        yz=(along_chord - along_normal) * sin * cos,
        torsion=rectangle_torsion_constant(c, h),
        pull=blades.material.density_kg_per_m3 * (inboard(blades.length_m) - inboard(x)),
    )


def blade_matrices(blades: BladeRow, root_radius: float) -> BeamMatrices:
    """Matrices of one blade, assembled from exact-statics two-node elements.

    Stiffness: the section forces of an element in equilibrium are b(x) F with F the forces at its outer end; with
    the section stiffness D the flexibility is f = int b^T D^-1 b dx and K = Gamma^T f^-1 Gamma, Gamma q the outer
    node's motion relative to the inner one carried rigidly. The displacement that belongs to it gives the shape
    functions N(x) of every other matrix: statics are exact at the nodes for any taper and twist, nothing locks.
    Frequencies converge with order 4 where bending rules, with order 2 where shear, torsion or extension do.

    M = int rho N^T N, G = int rho N^T (e_z x N), S = int rho N^T (1 - e_z e_z^T) N, f_c = int rho N^T r_perp over the
    volume, so with rotary inertia; f_c holds the propeller moment -rho I_yz about x. K_sigma, at 1 rad/s, is twice
    the energy per length of P (u_y'^2 + u_z'^2) / 2 + P I_p / A th_x'^2 / 2 + E2, P(x) = int_x^L rho A r dr, where
    E2 = rho [I_y2 (th_x^2 + th_z^2) - I_yz th_y th_z] / 2 is the work of the centrifugal load on the second-order
    displacement th x (th x s) / 2 of the section.

    Not in it: warping, the coupling of extension with twist, the geometric stiffness of the steady twisting moment.
    Checked against closed forms, shooting and published rotating beams in tests/fem/test_beam*.py.
    """
    elements = blades.elements
    step = blades.length_m / elements
    starts = step * np.arange(elements)
    shape, strain = _shape_functions(blades, root_radius, starts, step)
    points, weights = _gauss(step)
    sections = blade_sections(blades, root_radius, starts[:, None] + points)
    rho = blades.material.density_kg_per_m3
    radius = root_radius + starts[:, None] + points
    gradient = strain.copy()
    gradient[:, :, 1, :] += shape[:, :, 5, :]  # u_y' = gamma_y + th_z
    gradient[:, :, 2, :] -= shape[:, :, 4, :]  # u_z' = gamma_z - th_y

    def integral(fields: FloatArray, section: FloatArray) -> FloatArray:
        weighted = weights[:, None, None] * (section @ fields)
        return _assemble(np.sum(np.swapaxes(fields, -1, -2) @ weighted, axis=1))

    load = rho * np.einsum("g,egif,egi->ef", weights, shape, _centrifugal_load(sections, radius))
    stiffness = integral(strain, _section_stiffness(blades, sections))
    return BeamMatrices(
        M=_symmetric(integral(shape, rho * _section_mass(sections))),
        K=_symmetric(stiffness),
        G=_skew(integral(shape, rho * _section_coriolis(sections))),
        S=_symmetric(integral(shape, rho * _section_spin(sections))),
        K_sigma=_symmetric(
            integral(gradient, _section_pull(sections)) + integral(shape, rho * _second_order(sections))
        ),
        f_c=_assemble_vector(load),
        root_pull=float(blade_sections(blades, root_radius, np.zeros(1)).pull[0]),
    )


def _linear(root: float, tip: float, length: float) -> Polynomial:
    return Polynomial([root, (tip - root) / length])


def _gauss(length: float | FloatArray) -> tuple[FloatArray, FloatArray]:
    """Gauss points and weights on 0..length."""
    points, weights = leggauss(GAUSS_POINTS)
    scale = np.asarray(length, dtype=np.float64)[..., None] / 2
    return scale * (points + 1), scale * weights


def _shape_functions(
    blades: BladeRow, root_radius: float, starts: FloatArray, step: float
) -> tuple[FloatArray, FloatArray]:
    """N(x) and section strains at the Gauss points, each (element, point, 6, 12), from the element's exact statics."""

    def flexibility(ends: FloatArray) -> FloatArray:
        """int_0^end b_end^T D^-1 b ds: motion at `end` by unit forces at the element's outer end."""
        inner, weights = _gauss(ends)
        sections = blade_sections(blades, root_radius, starts[:, None, None] + inner)
        compliance = np.linalg.inv(_section_stiffness(blades, sections))
        at_end = np.swapaxes(_equilibrium(ends[:, None] - inner), -1, -2)
        return np.sum(weights[..., None, None] * (at_end @ compliance @ _equilibrium(step - inner)), axis=2)

    points, _ = _gauss(step)
    inverse = np.linalg.inv(flexibility(np.array([step])))
    relative = np.concatenate([-_rigid(np.array(step)), np.eye(6)], axis=1)
    end_forces = inverse @ relative
    rigid = np.concatenate([_rigid(points), np.zeros((points.size, 6, 6))], axis=-1)
    shape: FloatArray = rigid + flexibility(points) @ end_forces
    sections = blade_sections(blades, root_radius, starts[:, None] + points)
    compliance = np.linalg.inv(_section_stiffness(blades, sections))
    strain: FloatArray = compliance @ _equilibrium(step - points) @ end_forces
    return shape, strain


def _equilibrium(arm: FloatArray) -> FloatArray:
    """b: section forces (N, V_y, V_z, M_x, M_y, M_z) of unit forces that act a distance `arm` further out."""
    b = np.zeros((*arm.shape, 6, 6))
    b[..., range(6), range(6)] = 1.0
    b[..., 4, 2], b[..., 5, 1] = -arm, arm
    return b


def _rigid(x: FloatArray) -> FloatArray:
    """Motion at x of a body that is carried by the node at 0: u + th x (x e_x)."""
    return np.swapaxes(_equilibrium(x), -1, -2)


def _section_stiffness(blades: BladeRow, s: BladeSections) -> FloatArray:
    E, G = blades.material.youngs_modulus_pa, blades.material.shear_modulus_pa
    shear = cowper_shear_coefficient(blades.material.poisson_ratio) * G * s.area
    D = _bending(E * s.yy, E * s.zz, E * s.yz)
    D[..., 0, 0], D[..., 1, 1], D[..., 2, 2], D[..., 3, 3] = E * s.area, shear, shear, G * s.torsion
    return D


def _section_mass(s: BladeSections) -> FloatArray:
    m = _bending(s.yy, s.zz, s.yz)
    m[..., 0, 0] = m[..., 1, 1] = m[..., 2, 2] = s.area
    m[..., 3, 3] = s.yy + s.zz
    return m


def _section_spin(s: BladeSections) -> FloatArray:
    """u_x^2 + u_y^2 over the section, u_x = th_y z - th_z y, u_y = -th_x z."""
    m = _bending(s.yy, s.zz, s.yz)
    m[..., 0, 0] = m[..., 1, 1] = s.area
    m[..., 3, 3] = s.zz
    return m


def _section_coriolis(s: BladeSections) -> FloatArray:
    """du . (e_z x u) = du_y u_x - du_x u_y over the section."""
    m = np.zeros((*s.area.shape, 6, 6))
    m[..., 1, 0], m[..., 0, 1] = s.area, -s.area
    m[..., 4, 3], m[..., 3, 4] = s.zz, -s.zz
    m[..., 5, 3], m[..., 3, 5] = -s.yz, s.yz
    return m


def _section_pull(s: BladeSections) -> FloatArray:
    m = np.zeros((*s.area.shape, 6, 6))
    m[..., 1, 1] = m[..., 2, 2] = s.pull
    m[..., 3, 3] = s.pull * (s.yy + s.zz) / s.area
    return m


def _second_order(s: BladeSections) -> FloatArray:
    m = np.zeros((*s.area.shape, 6, 6))
    m[..., 3, 3] = m[..., 5, 5] = s.yy
    m[..., 4, 5] = m[..., 5, 4] = -s.yz / 2
    return m


def _centrifugal_load(s: BladeSections, radius: FloatArray) -> FloatArray:
    """int r_perp . (u + th x s) dA, r_perp = (r, y, 0): a pull along x and the propeller moment about x."""
    load = np.zeros((*s.area.shape, 6))
    load[..., 0] = s.area * radius
    load[..., 3] = -s.yz
    return load


def _bending(yy: FloatArray, zz: FloatArray, yz: FloatArray) -> FloatArray:
    """(th_y z - th_z y)^2 over the section as the last two rows of a 6 x 6 matrix."""
    m = np.zeros((*yy.shape, 6, 6))
    m[..., 4, 4], m[..., 5, 5] = zz, yy
    m[..., 4, 5] = m[..., 5, 4] = -yz
    return m


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


def _symmetric(matrix: FloatArray) -> FloatArray:
    return (matrix + matrix.T) / 2


def _skew(matrix: FloatArray) -> FloatArray:
    return (matrix - matrix.T) / 2
