"""The disk against closed forms: mass properties, plates, membranes and rotating stress."""

import numpy as np
import pytest
from scipy.sparse.linalg import LinearOperator, eigsh

from rubgen.fem.disk import assemble_disk
from rubgen.fem.shell import shell_stress_stiffness
from rubgen.fem.statics import factorize
from rubgen.machine import Disk, Material, load_machine

STEEL = Material(youngs_modulus_pa=2.06e11, poisson_ratio=0.3, density_kg_per_m3=7850.0)
NU = 0.3
U, V, W, TH_X, TH_Y, TH_Z = range(6)


def annulus(bore, thickness, radial=7, circumferential=72):
    return Disk(
        material=STEEL,
        bore_radius_m=bore,
        rim_radius_m=1.0,
        bore_thickness_m=thickness,
        rim_thickness_m=thickness,
        radial_elements=radial,
        circumferential_elements=circumferential,
    )


def lowest(M, K, free, count):
    """Lowest eigenvalues omega^2 and vectors of the free DoFs."""
    K, M = K[free][:, free], M[free][:, free]
    inverse = LinearOperator(K.shape, matvec=factorize(K).solve, dtype=float)
    squares, modes = eigsh(K, count, M, sigma=0.0, OPinv=inverse, v0=np.sin(1.0 + np.arange(len(free))), tol=1e-11)
    order = np.argsort(squares)
    return squares[order], modes[:, order]


def polynomial_integral(power, bore, rim, disk):
    """Integral of r^power h(r) dr of the linear thickness."""
    slope = (disk.rim_thickness_m - disk.bore_thickness_m) / (rim - bore)
    level = disk.bore_thickness_m - slope * bore
    return level * (rim ** (power + 1) - bore ** (power + 1)) / (power + 1) + slope * (
        rim ** (power + 2) - bore ** (power + 2)
    ) / (power + 2)


def test_mass_and_moments_of_inertia_of_the_tapered_disk():
    disk = load_machine("zeng2019").disk
    model = assemble_disk(disk)
    a, b, rho = disk.bore_radius_m, disk.rim_radius_m, disk.material.density_kg_per_m3
    r, weight = np.polynomial.legendre.leggauss(8)
    r, weight = (b - a) / 2 * (r + 1) + a, weight * (b - a) / 2
    h = disk.bore_thickness_m + (disk.rim_thickness_m - disk.bore_thickness_m) * (r - a) / (b - a)
    mass = 2 * np.pi * rho * np.sum(weight * r * h)
    polar = 2 * np.pi * rho * np.sum(weight * r**3 * h)
    diametral = polar / 2 + 2 * np.pi * rho * np.sum(weight * r * h**3) / 12
    x, y = model.mesh.nodes.T
    zero, one = np.zeros_like(x), np.ones_like(x)
    shift = np.stack([zero, zero, one, zero, zero, zero], axis=1).ravel()
    spin = np.stack([-y, x, zero, zero, zero, one], axis=1).ravel()
    tilt = np.stack([zero, zero, y, one, zero, zero], axis=1).ravel()
    assert shift @ (model.M @ shift) == pytest.approx(mass, rel=1e-6)
    assert spin @ (model.M @ spin) == pytest.approx(polar, rel=1e-6)
    assert tilt @ (model.M @ tilt) == pytest.approx(diametral, rel=1e-6)
    # int rho r dV over the disk, as the load pulls along each radius
    radial = np.stack([x, y, zero, zero, zero, zero], axis=1).ravel()
    assert radial @ model.f_c == pytest.approx(polar, rel=1e-6)


def test_coriolis_matrix_is_skew_and_spin_softening_leaves_out_the_axis():
    model = assemble_disk(annulus(0.3, 0.1, radial=2, circumferential=8))
    assert abs(model.G + model.G.T).max() < 1e-14 * abs(model.G).max()
    n = model.M.shape[0] // 6
    x, y = model.mesh.nodes.T
    motions = np.zeros((6, n, 6))
    motions[np.arange(6), :, np.arange(6)] = 1.0
    motions[TH_X, :, W], motions[TH_Y, :, W] = y, -x
    motions[TH_Z, :, U], motions[TH_Z, :, V] = -y, x
    R = motions.reshape(6, -1)
    mass, polar = R[U] @ model.M @ R[U], R[TH_Z] @ model.M @ R[TH_Z]
    rotary = R[TH_X] @ model.M @ R[TH_X] - polar / 2  # int rho z^2 = I_d - I_p / 2
    np.testing.assert_allclose(R @ (model.S @ R.T), np.diag([mass, mass, 0, rotary, rotary, polar]), atol=1e-9 * mass)
    expected = np.zeros((6, 6))
    expected[V, U], expected[U, V] = mass, -mass  # e_z x of the motion by u is along v
    expected[TH_Y, TH_X], expected[TH_X, TH_Y] = rotary, -rotary
    np.testing.assert_allclose(R @ (model.G @ R.T), expected, atol=1e-9 * mass)


@pytest.mark.parametrize(
    ("thickness", "expected", "tolerance"),
    [
        (0.1, (6.5178, 6.3173, 7.5538, 12.6929), 2e-4),  # Mindlin, h/a = 0.1, kappa = 5/6
        (0.01, (6.6604, 6.5523, 7.9565, 13.2757), 2e-3),  # Kirchhoff; h/a = 0.01 lies 0.02 to 0.16 % below it
    ],
)
def test_frequencies_of_an_annular_plate_clamped_inside(thickness, expected, tolerance):
    model = assemble_disk(annulus(0.3, thickness))
    n = model.M.shape[0] // 6
    plate = (6 * np.arange(n)[:, None] + np.array([W, TH_X, TH_Y])).ravel()
    free = np.setdiff1d(plate, (6 * model.bore[:, None] + np.arange(6)).ravel())
    squares, _ = lowest(model.M, model.K, free, 7)
    D = STEEL.youngs_modulus_pa * thickness**3 / 12 / (1 - NU**2)
    scaled = np.sqrt(squares * STEEL.density_kg_per_m3 * thickness / D)
    by_diameters = scaled[[2, 0, 3, 5]]  # ascending: 1, 1, 0, 2, 2, 3, 3
    np.testing.assert_allclose(by_diameters, expected, rtol=tolerance)
    np.testing.assert_allclose(scaled[[0, 3, 5]], scaled[[1, 4, 6]], rtol=1e-8)


def rotating_displacement(model):
    """Static displacement at 1 rad/s, the bore held."""
    n = model.M.shape[0] // 6
    membrane = (6 * np.arange(n)[:, None] + np.array([U, V, TH_Z])).ravel()
    free = np.setdiff1d(membrane, (6 * model.bore[:, None] + np.arange(6)).ravel())
    q = np.zeros(6 * n)
    q[free] = factorize(model.K[free][:, free]).solve(model.f_c[free])
    return q


def test_rotating_disk_grows_as_in_plane_stress():
    # u = A r + B/r - (1 - nu^2) rho r^3 / (8 E) with u(bore) = 0 and sigma_r(rim) = 0 (Timoshenko).
    a, E, rho = 0.3, STEEL.youngs_modulus_pa, STEEL.density_kg_per_m3
    c = (1 - NU**2) * rho / (8 * E)
    A, B = np.linalg.solve([[a, 1 / a], [1 + NU, -(1 - NU)]], [c * a**3, c * (3 + NU)])
    model = assemble_disk(annulus(a, 0.1))
    q = rotating_displacement(model).reshape(-1, 6)
    r = np.linalg.norm(model.mesh.nodes, axis=1)
    radial = np.einsum("ij,ij->i", q[:, :2], model.mesh.nodes) / r
    np.testing.assert_allclose(radial, A * r + B / r - c * r**3, atol=2e-4 * radial.max())


def test_spinning_membrane_disk_has_the_frequencies_of_lamb_and_southwell():
    # (omega/Omega)^2 = [(n+2s)(n+2s+2)(3+nu) - n^2 (1+3 nu)] / 8, s = 0, n = 0..4 and s = 1, n = 0, 1.
    # Its stress is given here; the small bore is free, which matters little where the modes r^n vanish.
    model = assemble_disk(annulus(0.03, 1e-4, radial=16, circumferential=48))
    r = np.linalg.norm(model.mesh.nodes, axis=1)
    factor = STEEL.density_kg_per_m3 / (8 * STEEL.youngs_modulus_pa)
    growth = factor * ((1 - NU) * (3 + NU) - (1 - NU**2) * r**2)  # u / r of the solid disk (Timoshenko)
    q = np.zeros((len(r), 6))
    q[:, :2] = growth[:, None] * model.mesh.nodes
    K = shell_stress_stiffness(model.mesh, STEEL, q.ravel())
    out_of_plane = 6 * np.arange(len(r)) + W
    # The uniform motion has omega = 0: a shift by 1 makes the membrane regular.
    squares, _ = lowest(model.M, (K + model.M).tocsr(), out_of_plane, 12)
    expected = [0, 1, 1, 2.35, 2.35, 3.3, 4.05, 4.05, 5.95, 5.95, 6.1, 6.1]
    np.testing.assert_allclose(squares - 1, expected, rtol=5e-3, atol=1e-10)
