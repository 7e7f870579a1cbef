"""Frequencies of the pre-twisted tapered blade against shooting through its differential equations."""

import dataclasses

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from scipy.optimize import brentq
from test_beam_statics import RADIUS, TWISTED, section

from rubgen.fem.beam import blade_matrices
from rubgen.fem.beam_sections import rectangle_torsion_constant
from rubgen.machine.machine import BladeRow

E, G, RHO = 2.06e11, 2.06e11 / 2.6, 7850.0
KAPPA = 13 / 15.3


def system_matrix(blades: BladeRow, x: float, omega: float) -> np.ndarray:
    """y' = A y for y = (u, th, forces, moments) of free vibration; section tensors turned from principal axes."""
    chord, thickness, angle = section(blades, x)
    area = chord * thickness
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])  # columns: x, chord, normal
    torsion = float(rectangle_torsion_constant(np.array(chord), np.array(thickness)))
    about_chord, about_normal = chord * thickness**3 / 12, thickness * chord**3 / 12
    shear = turn @ np.diag([1 / (E * area), 1 / (KAPPA * G * area), 1 / (KAPPA * G * area)]) @ turn.T
    bend = turn @ np.diag([1 / (G * torsion), 1 / (E * about_chord), 1 / (E * about_normal)]) @ turn.T
    inertia = turn @ np.diag([about_chord + about_normal, about_chord, about_normal]) @ turn.T
    cross = np.array([[0.0, 0, 0], [0, 0, -1], [0, 1, 0]])  # e_x x
    A = np.zeros((12, 12))
    A[0:3, 3:6] = -cross  # u' = strain + th x e_x
    A[0:3, 6:9] = shear
    A[3:6, 9:12] = bend
    A[6:9, 0:3] = -(omega**2) * RHO * area * np.eye(3)
    A[9:12, 3:6] = -(omega**2) * RHO * inertia
    A[9:12, 6:9] = -cross  # M' = -e_x x F - rotary inertia
    return A


def free_end_determinant(blades: BladeRow, omega: float) -> float:
    """Zero where forces at the clamped root exist that leave none at the tip."""
    length = blades.length_m
    scale = np.array([1, 1, 1, 1 / length, 1 / length, 1 / length] + [1e5] * 3 + [1e5 * length] * 3)
    start = np.vstack([np.zeros((6, 6)), np.eye(6)])

    def slope(x: float, y: np.ndarray) -> np.ndarray:
        A = system_matrix(blades, x, omega) / scale[:, None] * scale
        return (A @ y.reshape(12, 6)).ravel()

    end = solve_ivp(slope, (0, length), start.ravel(), rtol=1e-9, atol=1e-9, method="DOP853").y[:, -1]
    return float(np.linalg.det(end.reshape(12, 6)[6:]))


def element_frequencies(blades: BladeRow) -> np.ndarray:
    m = blade_matrices(blades, RADIUS)
    return np.sqrt(eigh(m.K[6:, 6:], m.M[6:, 6:], eigvals_only=True)[:5])


def test_first_five_frequencies_of_a_twisted_tapered_blade() -> None:
    fine = element_frequencies(dataclasses.replace(TWISTED, elements=40))
    exact = np.array(
        [brentq(lambda w: free_end_determinant(TWISTED, w), 0.995 * w0, 1.001 * w0, rtol=1e-8) for w0 in fine]
    )
    np.testing.assert_allclose(fine, exact, rtol=2e-4)
    # Static shape functions are conforming: frequencies come from above, with order 2 where shear and torsion rule.
    coarse = element_frequencies(dataclasses.replace(TWISTED, elements=20))
    assert np.all(fine > exact * (1 - 1e-8))
    assert np.all(coarse > fine)
    np.testing.assert_allclose((coarse - exact) / (fine - exact), 4.0, atol=1.0)


def test_twist_matters() -> None:
    # Else the shooting test would not show that the planes are coupled rightly.
    straight = dataclasses.replace(TWISTED, root_angle_deg=0.0, tip_angle_deg=0.0)
    assert element_frequencies(straight)[1] / element_frequencies(TWISTED)[1] > 1.4
