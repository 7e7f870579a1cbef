"""A pre-twisted, tapered blade by other methods than elements: Runge-Kutta and shooting.

They start from the rectangle of each section itself, and share with the element only Saint-Venant's torsion constant.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.integrate import solve_ivp

from rubgen.arrays import FloatArray
from rubgen.fem.cross_sections import rectangle_torsion_constant
from rubgen.machine import BladeRow


def section(blades: BladeRow, x: float) -> tuple[float, float, float]:
    """Chord, thickness and angle in rad at a distance x from the root."""
    s = x / blades.length_m
    chord = blades.root_chord_m + s * (blades.tip_chord_m - blades.root_chord_m)
    thickness = blades.root_thickness_m + s * (blades.tip_thickness_m - blades.root_thickness_m)
    angle = blades.root_angle_deg + s * (blades.tip_angle_deg - blades.root_angle_deg)
    return chord, thickness, float(np.deg2rad(angle))


def section_points(chord: float, thickness: float, angle: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """y, z and area of nine points that integrate squares over the turned rectangle exactly."""
    points, weights = leggauss(3)
    a, b = (grid.ravel() for grid in np.meshgrid(points * chord / 2, points * thickness / 2, indexing="ij"))
    area = np.outer(weights, weights).ravel() * chord * thickness / 4
    return a * np.cos(angle) - b * np.sin(angle), a * np.sin(angle) + b * np.cos(angle), area


def compliances(blades: BladeRow, x: float) -> tuple[FloatArray, FloatArray]:
    """Strain per force and curvature per moment, (3, 3) in the blade's axes, from the principal ones."""
    chord, thickness, angle = section(blades, x)
    E, G, nu = blades.material.youngs_modulus_pa, blades.material.shear_modulus_pa, blades.material.poisson_ratio
    area, kappa = chord * thickness, 10 * (1 + nu) / (12 + 11 * nu)
    torsion = float(rectangle_torsion_constant(np.array(chord), np.array(thickness)))
    about_chord, about_normal = chord * thickness**3 / 12, thickness * chord**3 / 12
    turn = _turn(angle)
    shear = turn @ np.diag([1 / (E * area), 1 / (kappa * G * area), 1 / (kappa * G * area)]) @ turn.T
    bend = turn @ np.diag([1 / (G * torsion), 1 / (E * about_chord), 1 / (E * about_normal)]) @ turn.T
    return shear, bend


def tip_flexibility(blades: BladeRow) -> FloatArray:
    """Tip motion per unit tip force and moment (6, 6) of the clamped blade, by Runge-Kutta along it."""
    length = blades.length_m

    def slope(x: float, q: FloatArray, load: FloatArray) -> FloatArray:
        shear, bend = compliances(blades, x)
        moment = load[3:] + np.cross([length - x, 0, 0], load[:3])
        return np.concatenate([shear @ load[:3] + np.cross(q[3:], [1.0, 0, 0]), bend @ moment])

    columns = [
        solve_ivp(slope, (0, length), np.zeros(6), args=(load,), rtol=1e-10, atol=1e-18, method="DOP853").y[:, -1]
        for load in np.eye(6)
    ]
    return np.array(columns).T


def system_matrix(blades: BladeRow, x: float, omega: float) -> FloatArray:
    """A of y' = A y for y = (u, th, forces, moments) of free vibration at rest."""
    chord, thickness, angle = section(blades, x)
    shear, bend = compliances(blades, x)
    area, rho = chord * thickness, blades.material.density_kg_per_m3
    about_chord, about_normal = chord * thickness**3 / 12, thickness * chord**3 / 12
    inertia = _turn(angle) @ np.diag([about_chord + about_normal, about_chord, about_normal]) @ _turn(angle).T
    cross = np.array([[0.0, 0, 0], [0, 0, -1], [0, 1, 0]])  # e_x x
    A = np.zeros((12, 12))
    A[0:3, 3:6] = -cross  # u' = strain + th x e_x
    A[0:3, 6:9] = shear
    A[3:6, 9:12] = bend
    A[6:9, 0:3] = -(omega**2) * rho * area * np.eye(3)
    A[9:12, 3:6] = -(omega**2) * rho * inertia
    A[9:12, 6:9] = -cross  # M' = -e_x x F - rotary inertia
    return A


def free_end_determinant(blades: BladeRow, omega: float) -> float:
    """Zero where forces at the clamped root exist that leave none at the tip: omega (rad/s) is a frequency."""
    length = blades.length_m
    scale = np.array([1, 1, 1, 1 / length, 1 / length, 1 / length] + [1e5] * 3 + [1e5 * length] * 3)
    start = np.vstack([np.zeros((6, 6)), np.eye(6)])

    def slope(x: float, y: FloatArray) -> FloatArray:
        A = system_matrix(blades, x, omega) / scale[:, None] * scale
        return np.asarray((A @ y.reshape(12, 6)).ravel())

    end = solve_ivp(slope, (0, length), start.ravel(), rtol=1e-9, atol=1e-9, method="DOP853").y[:, -1]
    return float(np.linalg.det(end.reshape(12, 6)[6:]))


def _turn(angle: float) -> FloatArray:
    """Columns: x, chord, thickness normal."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0, 0], [0, c, -s], [0, s, c]])
