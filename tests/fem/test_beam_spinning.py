"""The blade element in rotation, beside the published rotating beams of tests/validation/test_verification.py."""

import dataclasses

import numpy as np
import pytest
from numpy.polynomial import Legendre
from scipy.linalg import eigh
from scipy.spatial.transform import Rotation
from test_beam_statics import rigid_motion, volume

from rubgen.fem.beam import blade_matrices
from rubgen.fem.cross_sections import cross_sections
from rubgen.machine.machine import Material
from validation.verification.elements.beams import FLAP, THICK, TIMOSHENKO, cantilever_frequencies
from validation.verification.elements.twisted_blades import RADIUS, TWISTED


def test_rotary_spin_softening_is_seen() -> None:
    # 5.5381 is the published value without it.
    assert abs(cantilever_frequencies(4, THICK, FLAP, 80)[0] - 5.5381) > 6e-3


@pytest.mark.parametrize("spin", [0, 2, 4])
def test_forty_elements_hold_a_thick_beam_to_three_in_ten_thousand(spin: int) -> None:
    np.testing.assert_allclose(
        cantilever_frequencies(spin, THICK, FLAP, 40)[: len(TIMOSHENKO[spin])], TIMOSHENKO[spin], rtol=3e-4
    )


def test_rigid_rotation_sees_the_exact_centrifugal_potential() -> None:
    """Second derivative of V(phi) = -1/2 int rho |R(phi) r|_perp^2 for turns about any axis through the origin.

    The blade hangs on a rigid link of length RADIUS that carries the root's pull P: turning it by th about y or z
    moves the root sideways by RADIUS th and costs P RADIUS th^2 / 2, the link's own geometric stiffness.
    """
    m, pull = blade_matrices(TWISTED, RADIUS), float(cross_sections(TWISTED, RADIUS, np.zeros(1)).pull[0])
    r, mass = volume(TWISTED)

    def potential(axis: np.ndarray, angle: float) -> float:
        turned = Rotation.from_rotvec(angle * axis).apply(r)
        return float(-mass @ (turned[:, 0] ** 2 + turned[:, 1] ** 2) / 2)

    rng = np.random.default_rng(3)
    axes = np.vstack([np.eye(3), rng.normal(size=(4, 3))])
    for axis in axes / np.linalg.norm(axes, axis=1, keepdims=True):
        q = rigid_motion(TWISTED, np.cross(axis, [RADIUS, 0, 0]), axis)
        ours = q @ (m.K_sigma - m.S) @ q + pull * RADIUS * (axis[1] ** 2 + axis[2] ** 2)
        h = 1e-3
        exact = (potential(axis, h) - 2 * potential(axis, 0.0) + potential(axis, -h)) / h**2
        # atol: the difference quotient's rounding; the twist-plane terms are 1e-4 of the large ones.
        assert ours == pytest.approx(exact, rel=1e-6, abs=2e-9)


def test_section_terms_of_a_turn_about_the_blades_axis() -> None:
    # Exact: int rho (y^2 - z^2), the tennis-racket stiffness.
    upright = dataclasses.replace(TWISTED, root_angle_deg=90.0, tip_angle_deg=90.0)
    m = blade_matrices(upright, RADIUS)
    r, mass = volume(upright)
    q = rigid_motion(upright, np.zeros(3), np.array([1.0, 0, 0]))
    assert q @ (m.K_sigma - m.S) @ q == pytest.approx(mass @ (r[:, 1] ** 2 - r[:, 2] ** 2), rel=1e-9)


def test_torsion_of_a_spinning_blade() -> None:
    """Omega^2 rho I_p th = -((G J + P I_p / A) th')' + Omega^2 rho (I_y2 - I_z2) th, by Galerkin in polynomials x P_k.

    The pull stiffens a twisting strip like a bundle of strings (trapeze effect), the flat section turns back into the
    plane of rotation (tennis-racket effect). Soft material makes both as large as the elastic torsion.
    """
    length, c, h, spin = 0.3, 60e-3, 4e-3, 1000.0
    rubber = Material(youngs_modulus_pa=2e9, poisson_ratio=0.3, density_kg_per_m3=7850.0)
    blades = dataclasses.replace(
        TWISTED,
        material=rubber,
        length_m=length,
        root_chord_m=c,
        tip_chord_m=c,
        root_thickness_m=h,
        tip_thickness_m=h,
        root_angle_deg=0.0,
        tip_angle_deg=0.0,
        elements=60,
    )
    m = blade_matrices(blades, RADIUS)
    free = np.arange(9, m.M.shape[0], 6)
    K = (m.K + spin**2 * (m.K_sigma - m.S))[np.ix_(free, free)]
    ours = np.sqrt(eigh(K, m.M[np.ix_(free, free)], eigvals_only=True)[:2])

    p, w = np.polynomial.legendre.leggauss(60)
    x, w = (p + 1) / 2 * length, w / 2 * length
    basis = [Legendre.basis(k, domain=[0, length]) * Legendre([length / 2, length / 2], [0, length]) for k in range(25)]
    field, slope = np.array([b(x) for b in basis]), np.array([b.deriv()(x) for b in basis])
    yy, zz = h * c**3 / 12, c * h**3 / 12
    pull = 7850.0 * c * h * spin**2 * ((RADIUS + length) ** 2 - (RADIUS + x) ** 2) / 2
    torsion = c * h**3 * (1 / 3 - 0.21 * h / c)
    elastic, trapeze = 2e9 / 2.6 * torsion, pull * (yy + zz) / (c * h)
    racket = spin**2 * 7850.0 * (yy - zz)
    exact = (slope * w * (elastic + trapeze)) @ slope.T + racket * (field * w) @ field.T
    np.testing.assert_allclose(
        ours, np.sqrt(eigh(exact, 7850.0 * (yy + zz) * (field * w) @ field.T, eigvals_only=True)[:2]), rtol=5e-4
    )
    assert trapeze.mean() > 0.3 * elastic
