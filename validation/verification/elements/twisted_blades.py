"""Pre-twisted, tapered blades at rest and in rotation.

One blade with 90 degrees of twist, tapered in chord and thickness, is clamped at its root at a radius of 0.25 m.
Its statics are exact for any number of elements. Its frequencies converge with order 2 in the element length, so 20
and 40 elements are extrapolated to zero length (Richardson). The remaining error falls with the fourth power and is
below 1e-5.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import numpy as np
from scipy.linalg import block_diag, eig
from scipy.optimize import brentq

from rubgen.arrays import FloatArray
from rubgen.fem.beam import blade_matrices
from rubgen.machine import BladeRow, Material
from validation.verification.elements.blade_oracles import free_end_determinant, tip_flexibility
from validation.verification.elements.blade_ritz import ritz_frequencies
from validation.verification.row import Row, relative, within

TITLE = "Pre-twisted, tapered blades"
RADIUS = 0.25
SPIN = 1500.0
MODES = 5
TWISTED = BladeRow(
    material=Material(youngs_modulus_pa=2.06e11, poisson_ratio=0.3, density_kg_per_m3=7850.0),
    count=2,
    length_m=0.15,
    root_chord_m=48e-3,
    tip_chord_m=30e-3,
    root_thickness_m=6e-3,
    tip_thickness_m=3e-3,
    root_angle_deg=-20.0,
    tip_angle_deg=70.0,
    elements=6,
)


def element_flexibility(blades: BladeRow) -> FloatArray:
    """Tip motion per unit tip force and moment (6, 6) of the clamped blade, from its elements."""
    return np.asarray(np.linalg.inv(blade_matrices(blades, RADIUS).K[6:, 6:])[-6:, -6:], dtype=np.float64)


def element_frequencies(blades: BladeRow, speed: float = 0.0) -> FloatArray:
    """Lowest frequencies (5,) in rad/s of the clamped blade turning at `speed` (rad/s), from its elements."""
    m = blade_matrices(blades, RADIUS)
    K = (m.K + speed**2 * (m.K_sigma - m.S))[6:, 6:]
    n = len(K)
    companion = np.block([[np.zeros((n, n)), np.eye(n)], [-K, -2 * speed * m.G[6:, 6:]]])
    values = eig(companion, block_diag(np.eye(n), m.M[6:, 6:]), right=False)
    frequencies: FloatArray = np.sort(np.abs(values.imag))[::2][:MODES]
    return frequencies


def extrapolated(speed: float) -> FloatArray:
    """Frequencies (5,) in rad/s at vanishing element length."""
    coarse, fine = (element_frequencies(dataclasses.replace(TWISTED, elements=n), speed) for n in (20, 40))
    return fine + (fine - coarse) / 3


def shooting_frequency(guess: float) -> float:
    """The frequency in rad/s near `guess` by shooting through the differential equations."""
    return float(brentq(lambda w: free_end_determinant(TWISTED, w), 0.999 * guess, 1.001 * guess, rtol=1e-9))


def rows() -> Iterator[Row]:
    """Statics, then frequencies at rest and at 1,500 rad/s."""
    exact = tip_flexibility(TWISTED)
    size = np.sqrt(np.outer(np.diag(exact), np.diag(exact)))
    for elements, tolerance in ((1, 1e-7), (6, 1e-9)):
        found = element_flexibility(dataclasses.replace(TWISTED, elements=elements))
        quantity = f"largest relative error of the tip flexibility, {elements} element{'s' * (elements > 1)}"
        error = float(np.abs((found - exact) / size).max())
        yield within(quantity, "Runge-Kutta along the blade", 0.0, error, tolerance)
    for mode, found in enumerate(extrapolated(0.0), start=1):
        quantity = f"frequency {mode} of the twisted blade at rest, rad/s"
        yield relative(quantity, "shooting (Runge-Kutta)", shooting_frequency(found), found, 1e-5)
    ritz = ritz_frequencies(TWISTED, RADIUS, SPIN, MODES)
    for mode, (expected, found) in enumerate(zip(ritz, extrapolated(SPIN), strict=True), start=1):
        quantity = f"frequency {mode} of the twisted blade turning at {SPIN:g} rad/s, rad/s"
        yield relative(quantity, "Rayleigh-Ritz, 14 polynomials a field", expected, found, 1e-5)
