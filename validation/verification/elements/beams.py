"""Rotating uniform and tapered beams.

Frequencies are omega sqrt(rho A L^4 / EI) of a cantilever, with A and I at its root. The spin Omega has the same
scale, and the hub radius is 0. If the source is an Euler-Bernoulli beam, a radius of gyration of 1e-4 L makes shear
negligible. Tables have four decimals (half a unit: 5e-5). There 40 elements converge with order 4, and the error is
below 5e-5 (relative to the frequency at the third mode: 2e-6). The Timoshenko beam converges with order 2, so two
meshes are extrapolated to zero element length (Richardson).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.linalg import eigh

from rubgen.arrays import FloatArray
from rubgen.fem.beam import blade_matrices
from rubgen.machine import BladeRow, Material
from validation.verification.row import Row, within

TITLE = "Rotating beams"
# E / (kappa G) = (12 + 11 nu) / 5 = 3.059
MATERIAL = Material(youngs_modulus_pa=1.0, poisson_ratio=(5 * 3.059 - 12) / 11, density_kg_per_m3=1.0)
FLAP, LAG = (2, 4), (1, 5)
SLENDER, THICK = 1e-4, 1 / 30
EULER_BERNOULLI = {0: (3.5160, 22.0345, 61.6972), 2: (4.1373, 22.6149, 62.2732), 4: (5.5850, 24.2733, 63.9668)}
TIMOSHENKO: dict[int, tuple[float, ...]] = {0: (3.4798, 20.5892, 53.3398), 2: (4.0971, 21.1766, 53.9544), 4: (5.5314,)}
# Taper of chord and of thickness, tip = (1 - taper) root.
TAPERED = {(0.4, 0.4): (4.31878, 20.0500, 51.3346), (0.6, 0.2): (4.67816, 22.4774, 58.1466)}
TABLE_TOLERANCE = 1.5e-4


def cantilever(
    slenderness: float,
    plane: tuple[int, int],
    elements: int,
    taper: tuple[float, float] = (0.0, 0.0),
) -> BladeRow:
    """A straight blade of unit length with radius of gyration `slenderness` in that plane at its root."""
    depth, width = slenderness * np.sqrt(12), 0.3
    chord, thickness = (width, depth) if plane == FLAP else (depth, width)
    return BladeRow(
        material=MATERIAL,
        count=2,
        length_m=1.0,
        root_chord_m=chord,
        tip_chord_m=chord * (1 - taper[0]),
        root_thickness_m=thickness,
        tip_thickness_m=thickness * (1 - taper[1]),
        root_angle_deg=0.0,
        tip_angle_deg=0.0,
        elements=elements,
    )


def cantilever_frequencies(
    spin: float,
    slenderness: float,
    plane: tuple[int, int],
    elements: int,
    taper: tuple[float, float] = (0.0, 0.0),
) -> FloatArray:
    """First three scaled frequencies (3,) of motion in that plane at scaled spin, from the blade element."""
    m = blade_matrices(cantilever(slenderness, plane, elements, taper), 0.0)
    scale = slenderness**2  # EI / (rho A L^4)
    free = np.sort(np.concatenate([np.arange(6 + dof, m.M.shape[0], 6) for dof in plane]))
    K = m.K + spin**2 * scale * (m.K_sigma - m.S)
    squares: FloatArray = eigh(K[np.ix_(free, free)], m.M[np.ix_(free, free)], eigvals_only=True)
    return np.sqrt(squares[:3] / scale)


def extrapolated(spin: float) -> FloatArray:
    """Timoshenko frequencies at vanishing element length, from 40 and 80 elements of second order."""
    coarse, fine = (cantilever_frequencies(spin, THICK, FLAP, n) for n in (40, 80))
    return fine + (fine - coarse) / 3


def observed_order(slenderness: float) -> float:
    """Order in the element length at which the first frequency converges, from 8, 16 and 32 elements."""
    f = [cantilever_frequencies(2, slenderness, FLAP, n)[0] for n in (8, 16, 32)]
    return float(np.log2((f[0] - f[1]) / (f[1] - f[2])))


def rows() -> Iterator[Row]:
    """Flapwise, lagwise, thick and tapered beams, and the element's order."""
    thin = "Euler-Bernoulli beam by Legendre-Galerkin; Wright et al. 1982"
    for spin, table in EULER_BERNOULLI.items():
        found = cantilever_frequencies(spin, SLENDER, FLAP, 40)
        for mode, (expected, ours) in enumerate(zip(table, found, strict=True), start=1):
            yield within(f"flapwise frequency {mode} at Omega = {spin}", thin, expected, ours, TABLE_TOLERANCE)
    for spin in (2, 4):
        found = cantilever_frequencies(spin, SLENDER, LAG, 40)
        for mode, (flap, ours) in enumerate(zip(EULER_BERNOULLI[spin], found, strict=True), start=1):
            expected = np.sqrt(flap**2 - spin**2)
            source = "lag^2 = flap^2 - Omega^2"
            yield within(f"lagwise frequency {mode} at Omega = {spin}", source, expected, ours, TABLE_TOLERANCE)
    for spin, values in TIMOSHENKO.items():
        source = "Timoshenko beam by Legendre-Galerkin, r = L/30, E/(kappa G) = 3.059"
        for mode, (expected, ours) in enumerate(zip(values, extrapolated(spin), strict=False), start=1):
            quantity = f"Timoshenko flapwise frequency {mode} at Omega = {spin}"
            yield within(quantity, source, expected, ours, TABLE_TOLERANCE)
    for (chord, thickness), tapered in TAPERED.items():
        found = cantilever_frequencies(0, SLENDER, FLAP, 40, (chord, thickness))
        for mode, (expected, ours) in enumerate(zip(tapered, found, strict=True), start=1):
            quantity = f"flapwise frequency {mode}, chord tapered by {chord:.0%}, thickness by {thickness:.0%}"
            yield within(
                quantity,
                "double-tapered beams, doi 10.1186/s40712-015-0040-0, table 1",
                expected,
                ours,
                TABLE_TOLERANCE,
            )
    source = "Hermite bending of order 4, in the limit of small elements"
    yield within("beam: observed order, slender", source, 4.0, observed_order(SLENDER), 0.15)
    yield within("beam: observed order, with shear", "linear shear, order 2", 2.0, observed_order(THICK), 0.15)
