"""Spinning disks: growth, membranes, and plates under centrifugal stress.

The annular plate (nu = 0.3, h/a = 0.02) is clamped at b = 0.3 a and turns at Omega a^2 sqrt(rho h/D) = 4. The Ritz
solution with polynomials in the radius is converged to its last digit shown. The elements (7 x 72) have an error of
1e-3 in bending at that thickness. Coriolis terms and spin softening of the rotary inertia are left out on both
sides here. The tilting disk, below, checks them.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import scipy.sparse as sp
from numpy.polynomial.legendre import Legendre, leggauss
from scipy.linalg import eigh

from rubgen.arrays import FloatArray
from rubgen.fem.constraints import factorize
from rubgen.fem.disk import DiskModel, assemble_disk
from rubgen.fem.shell import shell_stress_stiffness
from validation.verification.elements.plates import STEEL, annulus, bending_stiffness, lowest, out_of_plane
from validation.verification.row import Row, relative

TITLE = "Spinning disks"
NU, RHO, E = STEEL.poisson_ratio, STEEL.density_kg_per_m3, STEEL.youngs_modulus_pa
BORE, THICKNESS, SCALED_SPIN = 0.3, 0.02, 4.0
MEMBRANE = {(1, 0): 1.0, (2, 0): 2.35, (0, 1): 3.3, (3, 0): 4.05, (1, 1): 5.95, (4, 0): 6.1}
RITZ_TERMS, RITZ_POINTS = 12, 40


def growth_constants(bore: float) -> tuple[float, float, float]:
    """A, B, c of u = A r + B / r - c r^3 at 1 rad/s in plane stress, u(bore) = 0, sigma_r(1) = 0 (Timoshenko)."""
    c = (1 - NU**2) * RHO / (8 * E)
    A, B = np.linalg.solve([[bore, 1 / bore], [1 + NU, -(1 - NU)]], [c * bore**3, c * (3 + NU)])
    return float(A), float(B), c


def rotating_displacement(model: DiskModel) -> FloatArray:
    """Static displacement (6 n,) at 1 rad/s, the bore held."""
    nodes = np.arange(len(model.mesh.nodes))
    in_plane = (6 * nodes[:, None] + np.array([0, 1, 5])).ravel()
    free = np.setdiff1d(in_plane, (6 * model.bore[:, None] + np.arange(6)).ravel())
    q = np.zeros(6 * len(nodes))
    q[free] = factorize(model.K[free][:, free]).solve(model.f_c[free])
    return q


def radial_displacement(model: DiskModel, radius: float) -> float:
    """Mean radial displacement at 1 rad/s of the nodes at a radius."""
    q, r = rotating_displacement(model).reshape(-1, 6), np.linalg.norm(model.mesh.nodes, axis=1)
    at = np.isclose(r, radius)
    return float(np.mean(np.einsum("ij,ij->i", q[at, :2], model.mesh.nodes[at]) / radius))


def membrane_squares(count: int) -> FloatArray:
    """(omega / Omega)^2 (count,) of a disk without bending stiffness, under the stress of the solid disk.

    Its stress is given here; the small bore is free, which matters little where the modes r^n vanish. A shift by 1
    makes the membrane regular, for its uniform motion has omega = 0.
    """
    model = assemble_disk(annulus(0.03, 1e-4, radial=16, circumferential=48))
    r = np.linalg.norm(model.mesh.nodes, axis=1)
    growth = RHO / (8 * E) * ((1 - NU) * (3 + NU) - (1 - NU**2) * r**2)  # u / r of the solid disk (Timoshenko)
    q = np.zeros((len(r), 6))
    q[:, :2] = growth[:, None] * model.mesh.nodes
    K = shell_stress_stiffness(model.mesh, STEEL, q.ravel())
    return lowest(model.M, sp.csr_array(K + model.M), 6 * np.arange(len(r)) + 2, count) - 1


def spinning_frequencies() -> FloatArray:
    """Scaled frequencies (4,) of the spinning annular plate with 0 to 3 nodal diameters, from the elements."""
    model = assemble_disk(annulus(BORE, THICKNESS))
    square = SCALED_SPIN**2 * bending_stiffness(THICKNESS) / (RHO * THICKNESS)
    K_sigma = shell_stress_stiffness(model.mesh, STEEL, rotating_displacement(model))
    squares = lowest(model.M, sp.csr_array(model.K + square * K_sigma), out_of_plane(model), 7)
    scaled: FloatArray = np.sqrt(squares / square) * SCALED_SPIN
    return scaled[[0, 1, 3, 5]]  # ascending: 0, 1, 1, 2, 2, 3, 3; at rest one nodal diameter comes first


def ritz_frequency(n: int) -> float:
    """The same by Rayleigh-Ritz in w, psi_r cos(n theta) and psi_t sin(n theta), each (r - b) times polynomials in r.

    Mindlin's energies of bending and shear; the stress in closed form, h sigma_ij w,i w,j and its h^3/12 on psi.
    """
    points, weights = leggauss(RITZ_POINTS)
    r, weight = BORE + (1 - BORE) * (points + 1) / 2, (1 - BORE) / 2 * weights
    basis = [Legendre.basis(k, [BORE, 1]) * Legendre([(1 - BORE) / 2] * 2, [BORE, 1]) for k in range(RITZ_TERMS)]
    value, slope = np.array([b(r) for b in basis]), np.array([b.deriv()(r) for b in basis])
    w, psi_r, psi_t = (np.kron(unit, value.T) for unit in np.eye(3))
    w_r, psi_rr, psi_tr = (np.kron(unit, slope.T) for unit in np.eye(3))
    D, shear, h = bending_stiffness(THICKNESS), 5 / 6 * STEEL.shear_modulus_pa * THICKNESS, THICKNESS
    x = r[:, None]
    hoop, twist = (psi_r + n * psi_t) / x, psi_tr - (psi_t + n * psi_r) / x

    def energy(a: FloatArray, b: FloatArray, density: float | FloatArray) -> FloatArray:
        half = a.T @ ((weight * r * density)[:, None] * b)
        return (half + half.T) / 2

    K = energy(psi_rr, psi_rr, D) + energy(hoop, hoop, D) + energy(psi_rr, hoop, 2 * NU * D)
    K += energy(twist, twist, (1 - NU) / 2 * D)
    K += energy(w_r + psi_r, w_r + psi_r, shear) + energy(psi_t - n * w / x, psi_t - n * w / x, shear)
    square = SCALED_SPIN**2 * D / (RHO * h)
    A, B, c = growth_constants(BORE)
    radial, round_ = A - B / r**2 - 3 * c * r**2, A + B / r**2 - c * r**2  # strains at 1 rad/s
    sigma_r, sigma_t = (square * E / (1 - NU**2) * (a + NU * b) for a, b in ((radial, round_), (round_, radial)))
    K += energy(w_r, w_r, h * sigma_r) + energy(n * w / x, n * w / x, h * sigma_t)
    for field, along in ((psi_rr, (n * psi_r + psi_t) / x), (psi_tr, (n * psi_t + psi_r) / x)):
        K += energy(field, field, h**3 / 12 * sigma_r) + energy(along, along, h**3 / 12 * sigma_t)
    M = energy(w, w, RHO * h) + energy(psi_r, psi_r, RHO * h**3 / 12) + energy(psi_t, psi_t, RHO * h**3 / 12)
    kept = np.flatnonzero(np.diag(M) > 0) if n else np.arange(2 * RITZ_TERMS)
    smallest = eigh(K[np.ix_(kept, kept)], M[np.ix_(kept, kept)], eigvals_only=True)[0]
    return float(np.sqrt(smallest / square) * SCALED_SPIN)


def rows() -> Iterator[Row]:
    """Growth, membrane, annular plate."""
    A, B, c = growth_constants(0.3)
    model = assemble_disk(annulus(0.3, 0.1))
    for radius in (0.65, 1.0):
        exact = A * radius + B / radius - c * radius**3
        quantity = f"spinning annular disk: growth at r = {radius:g} m and 1 rad/s, m"
        found = radial_displacement(model, radius)
        yield relative(quantity, "plane stress in closed form (Timoshenko)", exact, found, 1e-4)
    squares = membrane_squares(12)[[1, 3, 5, 6, 8, 10]]
    for ((n, s), expected), found in zip(MEMBRANE.items(), squares, strict=True):
        quantity = f"membrane disk: (omega/Omega)^2, {n} nodal diameters, {s} circles"
        yield relative(quantity, "Lamb, Southwell 1921", expected, found, 5e-3)
    for n, found in enumerate(spinning_frequencies()):
        quantity = f"spinning annular plate: frequency with {n} nodal diameters"
        yield relative(quantity, "Rayleigh-Ritz, 12 polynomials a field", ritz_frequency(n), found, 1e-3)
