"""The blade element: statics, rigid bodies, mass, axes."""

import dataclasses

import numpy as np
import pytest

from rubgen.fem.beam import BeamMatrices, blade_matrices
from rubgen.fem.cross_sections import cross_sections, rectangle_torsion_constant
from rubgen.machine.machine import BladeRow
from validation.verification.elements.blade_oracles import section
from validation.verification.elements.twisted_blades import RADIUS, TWISTED


def rigid_motion(blades: BladeRow, translation: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """Nodal values of u + th x (x e_x), th, with x from the root."""
    x = np.linspace(0, blades.length_m, blades.elements + 1)
    arm = np.column_stack([x, 0 * x, 0 * x])
    return np.hstack([translation + np.cross(rotation, arm), np.tile(rotation, (x.size, 1))]).ravel()


@pytest.fixture(scope="module")
def twisted() -> BeamMatrices:
    return blade_matrices(TWISTED, RADIUS)


def test_slender_uniform_cantilever_has_the_textbook_deflections() -> None:
    blades = dataclasses.replace(
        TWISTED, tip_chord_m=48e-3, tip_thickness_m=6e-3, root_angle_deg=0.0, tip_angle_deg=0.0, elements=3
    )
    K = blade_matrices(blades, RADIUS).K
    tip = np.linalg.inv(K[6:, 6:])[-6:, -6:]
    E, G, length, c, h = 2.06e11, 2.06e11 / 2.6, 0.15, 48e-3, 6e-3
    shear = length / (13 / 15.3 * G * c * h)
    assert tip[0, 0] == pytest.approx(length / (E * c * h), rel=1e-10)
    assert tip[1, 1] == pytest.approx(length**3 / (3 * E * h * c**3 / 12) + shear, rel=1e-10)  # lag: chord along y
    assert tip[2, 2] == pytest.approx(length**3 / (3 * E * c * h**3 / 12) + shear, rel=1e-10)  # flap: thickness along z
    # Roark: J = c h^3 (1/3 - 0.21 h / c (1 - h^4 / (12 c^4))), good to 4 digits for this shape.
    assert tip[3, 3] == pytest.approx(length / (G * c * h**3 * (1 / 3 - 0.21 * h / c)), rel=5e-4)


def test_square_torsion_constant() -> None:
    assert rectangle_torsion_constant(np.array(2.0), np.array(2.0)) == pytest.approx(0.140577 * 16, rel=1e-5)
    # Timoshenko and Goodier's table: J = 0.263 c h^3 for c = 3 h, whichever side is named first.
    for sides in ((1.0, 3.0), (3.0, 1.0)):
        assert rectangle_torsion_constant(*np.array(sides)) == pytest.approx(0.263 * 3, rel=2e-3)


def test_angle_ninety_puts_the_chord_along_the_axis_of_rotation() -> None:
    flat = dataclasses.replace(TWISTED, root_angle_deg=0.0, tip_angle_deg=0.0)
    upright = dataclasses.replace(TWISTED, root_angle_deg=90.0, tip_angle_deg=90.0)
    stiffness = [np.linalg.inv(blade_matrices(b, RADIUS).K[6:, 6:])[-6:, -6:] for b in (flat, upright)]
    assert stiffness[1][2, 2] == pytest.approx(stiffness[0][1, 1], rel=1e-9)
    assert stiffness[1][1, 1] == pytest.approx(stiffness[0][2, 2], rel=1e-9)
    # At 45 degrees the soft direction is the thickness normal, between -y and +z.
    slanted = dataclasses.replace(TWISTED, root_angle_deg=45.0, tip_angle_deg=45.0)
    tip = np.linalg.inv(blade_matrices(slanted, RADIUS).K[6:, 6:])[-6:, -6:]
    soft = np.array([-1.0, 1.0]) / np.sqrt(2)
    assert soft @ tip[1:3, 1:3] @ soft == pytest.approx(stiffness[0][2, 2], rel=1e-9)


def test_rigid_motion_costs_no_energy(twisted: BeamMatrices) -> None:
    rng = np.random.default_rng(1)
    for _ in range(3):
        q = rigid_motion(TWISTED, rng.normal(size=3), rng.normal(size=3))
        assert np.abs(twisted.K @ q).max() < 1e-9 * np.abs(twisted.K).max()
    eigenvalues = np.linalg.eigvalsh(twisted.K)
    assert np.sum(np.abs(eigenvalues) < 1e-10 * eigenvalues[-1]) == 6
    assert eigenvalues[6] > 0


def test_symmetry(twisted: BeamMatrices) -> None:
    for matrix in (twisted.M, twisted.K, twisted.S, twisted.K_sigma):
        np.testing.assert_array_equal(matrix, matrix.T)
    np.testing.assert_array_equal(twisted.G, -twisted.G.T)
    assert np.linalg.eigvalsh(twisted.M)[0] > 0


def volume(blades: BladeRow) -> tuple[np.ndarray, np.ndarray]:
    """Positions (points, 3) from the axis of rotation and masses of a fine Gauss cloud that fills the blade."""
    p, w = np.polynomial.legendre.leggauss(12)
    positions, masses = [], []
    for s, ws in zip((p + 1) / 2, w / 2, strict=True):
        chord, thickness, angle = section(blades, s * blades.length_m)
        a, b = (g.ravel() for g in np.meshgrid(p * chord / 2, p * thickness / 2, indexing="ij"))
        y, z = a * np.cos(angle) - b * np.sin(angle), a * np.sin(angle) + b * np.cos(angle)
        positions.append(np.column_stack([np.full_like(y, RADIUS + s * blades.length_m), y, z]))
        masses.append(7850.0 * ws * blades.length_m * np.outer(w, w).ravel() * chord * thickness / 4)
    return np.concatenate(positions), np.concatenate(masses)


def test_rigid_mass_coriolis_and_spin_matrices_are_those_of_the_solid(twisted: BeamMatrices) -> None:
    r, m = volume(TWISTED)
    root = np.array([RADIUS, 0, 0])
    spin = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 0]])
    nodal, solid = [], []
    for unit in np.eye(6):
        nodal.append(rigid_motion(TWISTED, unit[:3], unit[3:]))
        solid.append(unit[:3] + np.cross(unit[3:], r - root))
    R, U = np.array(nodal).T, np.array(solid)

    def inner(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return np.einsum("inx,jnx,n->ij", a, b, m)

    perpendicular = U * np.array([1.0, 1, 0])
    tolerance = {"rtol": 1e-8, "atol": 1e-12}
    np.testing.assert_allclose(R.T @ twisted.M @ R, inner(U, U), **tolerance)
    np.testing.assert_allclose(R.T @ twisted.G @ R, inner(U, U @ spin.T), **tolerance)
    np.testing.assert_allclose(R.T @ twisted.S @ R, inner(perpendicular, perpendicular), **tolerance)
    load = np.einsum("inx,nx,n->i", U, r * np.array([1.0, 1, 0]), m)
    np.testing.assert_allclose(R.T @ twisted.f_c, load, **tolerance)
    assert abs(load[3]) > 1e-6  # the propeller moment is there to be seen
    pull = cross_sections(TWISTED, RADIUS, np.zeros(1)).pull[0]
    assert pull == pytest.approx(float(m @ r[:, 0]), rel=1e-8)
