"""A turning pre-twisted, tapered blade by Rayleigh-Ritz, from the points of its sections."""

from __future__ import annotations

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.linalg import block_diag, eig

from rubgen.arrays import FloatArray
from rubgen.machine import BladeRow
from validation.verification.elements.blade_oracles import compliances, section, section_points

RITZ_TERMS = 14
RITZ_POINTS = 48


def ritz_frequencies(blades: BladeRow, root_radius: float, speed: float, count: int) -> FloatArray:
    """Lowest frequencies (count,) in rad/s of the clamped blade turning at `speed` (rad/s), by Rayleigh-Ritz.

    Polynomials x P_k for all six fields. Elastic energy of strains and curvatures, kinetic energy of the points of each
    section; the centrifugal potential -Omega^2/2 int rho |r_perp|^2 up to second order, where the centre line and the
    fibres shorten by (u_y'^2 + u_z'^2 + I_p/A th_x'^2) / 2 and a section turns by 1 + th x + (th x)^2 / 2.
    """
    points, weights = leggauss(RITZ_POINTS)
    x, w = blades.length_m * (points + 1) / 2, blades.length_m * weights / 2
    n = 6 * RITZ_TERMS
    M, K, G = np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n))
    for position, weight in zip(x, w, strict=True):
        field, slope = _ritz_fields(position, blades.length_m)
        shear, bend = compliances(blades, position)
        strain = slope[:3].copy()
        strain[1] -= field[5]
        strain[2] += field[4]
        K += weight * (strain.T @ np.linalg.inv(shear) @ strain + slope[3:].T @ np.linalg.inv(bend) @ slope[3:])
        mass, spin, coriolis = _inertia(blades, position, field)
        M += weight * mass
        G += weight * coriolis
        K += weight * speed**2 * (_centrifugal(blades, root_radius, position, field, slope) - spin)
    companion = np.block([[np.zeros((n, n)), np.eye(n)], [-K, -2 * speed * G]])
    values = eig(companion, block_diag(np.eye(n), M), right=False)
    frequencies: FloatArray = np.sort(np.abs(values.imag))[::2][:count]
    return frequencies


def _ritz_fields(x: float, length: float) -> tuple[FloatArray, FloatArray]:
    """Values and derivatives (6, n) of all fields' polynomials at x."""
    s = 2 * x / length - 1
    basis = [np.polynomial.Legendre.basis(k) * np.polynomial.Legendre([1.0, 1.0]) for k in range(RITZ_TERMS)]
    value = np.kron(np.eye(6), np.array([b(s) for b in basis]))
    slope = np.kron(np.eye(6), np.array([b.deriv()(s) for b in basis]) * 2 / length)
    return value.astype(np.float64), slope.astype(np.float64)


def _inertia(blades: BladeRow, x: float, field: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mass, spin softening and Coriolis (n, n) per length, summed over the points of the section."""
    rho = blades.material.density_kg_per_m3
    y, z, area = section_points(*section(blades, x))
    u_x = field[0] + z[:, None] * field[4] - y[:, None] * field[5]
    u_y = field[1] - z[:, None] * field[3]
    u_z = field[2] + y[:, None] * field[3]
    mass = rho * area[:, None]
    spin = u_x.T @ (mass * u_x) + u_y.T @ (mass * u_y)
    coriolis = u_y.T @ (mass * u_x)
    return spin + u_z.T @ (mass * u_z), spin, coriolis - coriolis.T


def _centrifugal(blades: BladeRow, root_radius: float, x: float, field: FloatArray, slope: FloatArray) -> FloatArray:
    """Twice the second-order part of the potential per length at 1 rad/s, without the squares of the displacement."""
    rho = blades.material.density_kg_per_m3
    y, z, area = section_points(*section(blades, x))
    yy, zz, yz = area @ y**2, area @ z**2, area @ (y * z)
    points, weights = leggauss(12)
    outer = x + (blades.length_m - x) * (points + 1) / 2
    sizes = np.array([section(blades, s)[:2] for s in outer]).prod(axis=1)
    pull = rho * (blades.length_m - x) / 2 * weights @ (sizes * (root_radius + outer))
    squares = [np.outer(row, row) for row in (slope[1], slope[2], slope[3], field[3], field[5])]
    shortening: FloatArray = pull * (squares[0] + squares[1] + (yy + zz) / area.sum() * squares[2])
    mixed = np.outer(field[4], field[5])
    turning = rho * (yy * (squares[3] + squares[4]) - yz * (mixed + mixed.T) / 2)
    total: FloatArray = shortening + turning
    return total
