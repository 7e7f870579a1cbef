"""Rectangular cross-sections of a pre-twisted, tapered blade: what the beam element integrates along its length.

A cross-section matrix is a quadratic form per length. It acts on the displacement (u_x, u_y, u_z, th_x, th_y, th_z) of
the centre line or on the six generalised strains. A point s = (0, y, z) moves by u + th x s. Each matrix has the shape
(..., 6, 6) for cross-sections of shape (...).
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial

from rubgen.arrays import FloatArray
from rubgen.machine.machine import BladeRow


@dataclass(frozen=True, kw_only=True)
class CrossSections:
    """The rectangular cross-sections of a blade at distances x from the root. All arrays have the shape of x."""

    area: FloatArray
    """int dA, m2."""
    yy: FloatArray
    """int y^2 dA, m4."""
    zz: FloatArray
    """int z^2 dA, m4."""
    yz: FloatArray
    """int y z dA, m4."""
    torsion: FloatArray
    """Saint-Venant torsion constant, m4."""
    pull: FloatArray
    """Axial force of all mass outboard at 1 rad/s, N s2."""


def cowper_shear_coefficient(poisson_ratio: float) -> float:
    """Return Cowper's shear coefficient of a rectangle, 10 (1 + nu) / (12 + 11 nu) (J. Appl. Mech. 33, 1966)."""
    return 10 * (1 + poisson_ratio) / (12 + 11 * poisson_ratio)


def rectangle_torsion_constant(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the Saint-Venant torsion constant of rectangles of sides `a` and `b` (m, same shape), in m^4.

    J = c h^3 / 3 (1 - 192 h / (pi^5 c) sum_{n odd} tanh(n pi c / (2 h)) / n^5), c >= h (Timoshenko and Goodier, Theory
    of Elasticity, art. 109). Twenty terms have an error of 1e-7.
    """
    c, h = np.maximum(a, b), np.minimum(a, b)
    series = sum(np.tanh(n * np.pi / 2 * c / h) / n**5 for n in range(1, 40, 2))
    constant: FloatArray = c * h**3 / 3 * (1 - 192 * h / (np.pi**5 * c) * series)
    return constant


def cross_sections(blades: BladeRow, root_radius: float, x: FloatArray) -> CrossSections:
    """Compute the properties of a blade's cross-sections at distances `x` (of any shape) in m from its root.

    Chord, thickness and angle are linear in x. The chord points along cos(angle) e_y + sin(angle) e_z, the thickness
    normal along -sin(angle) e_y + cos(angle) e_z: at angle 0 the blade lies flat in the plane of the disk.
    `root_radius` is the radius of the root, m.
    """
    chord = _linear(blades.root_chord_m, blades.tip_chord_m, blades.length_m)
    thickness = _linear(blades.root_thickness_m, blades.tip_thickness_m, blades.length_m)
    angle = np.deg2rad(_linear(blades.root_angle_deg, blades.tip_angle_deg, blades.length_m)(x))
    c, h = chord(x), thickness(x)
    along_chord, along_normal = h * c**3 / 12, c * h**3 / 12
    cos, sin = np.cos(angle), np.sin(angle)
    inboard = (chord * thickness * Polynomial([root_radius, 1.0])).integ()
    return CrossSections(
        area=c * h,
        yy=along_chord * cos**2 + along_normal * sin**2,
        zz=along_chord * sin**2 + along_normal * cos**2,
        yz=(along_chord - along_normal) * sin * cos,
        torsion=rectangle_torsion_constant(c, h),
        pull=blades.material.density_kg_per_m3 * (inboard(blades.length_m) - inboard(x)),
    )


def _linear(root: float, tip: float, length: float) -> Polynomial:
    return Polynomial([root, (tip - root) / length])


def cross_section_stiffness(blades: BladeRow, s: CrossSections) -> FloatArray:
    """Return D (..., 6, 6): internal forces by strains.

    The forces are (N, V_y, V_z, M_x, M_y, M_z), the strains (eps, gamma_y, gamma_z, th_x', th_y', th_z').
    """
    E, G = blades.material.youngs_modulus_pa, blades.material.shear_modulus_pa
    shear = cowper_shear_coefficient(blades.material.poisson_ratio) * G * s.area
    D = _bending(E * s.yy, E * s.zz, E * s.yz)
    D[..., 0, 0], D[..., 1, 1], D[..., 2, 2], D[..., 3, 3] = E * s.area, shear, shear, G * s.torsion
    return D


def cross_section_mass(s: CrossSections) -> FloatArray:
    """Return the quadratic form int |u + th x s|^2 dA of a mass matrix: translation and rotary inertia."""
    m = _bending(s.yy, s.zz, s.yz)
    m[..., 0, 0] = m[..., 1, 1] = m[..., 2, 2] = s.area
    m[..., 3, 3] = s.yy + s.zz
    return m


def cross_section_spin(s: CrossSections) -> FloatArray:
    """Return the quadratic form int u_x^2 + u_y^2 dA of spin softening, for the displacement u + th x s."""
    m = _bending(s.yy, s.zz, s.yz)
    m[..., 0, 0] = m[..., 1, 1] = s.area
    m[..., 3, 3] = s.zz
    return m


def cross_section_coriolis(s: CrossSections) -> FloatArray:
    """Return the bilinear form int du . (e_z x u) dA = int du_y u_x - du_x u_y dA of the Coriolis matrix G."""
    m = np.zeros((*s.area.shape, 6, 6))
    m[..., 1, 0], m[..., 0, 1] = s.area, -s.area
    m[..., 4, 3], m[..., 3, 4] = s.zz, -s.zz
    m[..., 5, 3], m[..., 3, 5] = -s.yz, s.yz
    return m


def cross_section_pull(s: CrossSections) -> FloatArray:
    """Return the quadratic form (..., 6, 6) of the pull P in K_sigma: P (u_y'^2 + u_z'^2) + P I_p / A th_x'^2.

    It acts on (-, u_y', u_z', th_x', -, -). P is `s.pull`, at 1 rad/s; it contains the density.
    """
    m = np.zeros((*s.area.shape, 6, 6))
    m[..., 1, 1] = m[..., 2, 2] = s.pull
    m[..., 3, 3] = s.pull * (s.yy + s.zz) / s.area
    return m


def cross_section_second_order(s: CrossSections) -> FloatArray:
    """Return the quadratic form I_y2 (th_x^2 + th_z^2) - I_yz th_y th_z, the part of rotations in K_sigma.

    It is (..., 6, 6), acts on (u, th), and is for unit density, with I_y2 = int y^2 dA and I_yz = int y z dA. It is
    minus twice the work of the centrifugal load (r, y, 0) on the second-order displacement th x (th x s) / 2.
    """
    m = np.zeros((*s.area.shape, 6, 6))
    m[..., 3, 3] = m[..., 5, 5] = s.yy
    m[..., 4, 5] = m[..., 5, 4] = -s.yz / 2
    return m


def cross_section_load(s: CrossSections, radius: FloatArray) -> FloatArray:
    """Return the centrifugal load per length at 1 rad/s and unit density, (..., 6).

    It is the work of r_perp = (r, y, 0) on u + th x s: a pull along x and the propeller moment about x. `radius` is r
    of the cross-sections in m.
    """
    load = np.zeros((*s.area.shape, 6))
    load[..., 0] = s.area * radius
    load[..., 3] = -s.yz
    return load


def _bending(yy: FloatArray, zz: FloatArray, yz: FloatArray) -> FloatArray:
    """Return (th_y z - th_z y)^2 over the cross-section as the last two rows of a 6 x 6 matrix."""
    m = np.zeros((*yy.shape, 6, 6))
    m[..., 4, 4], m[..., 5, 5] = zz, yy
    m[..., 4, 5] = m[..., 5, 4] = -yz
    return m
