"""The disk against closed forms; frequencies of plates and membranes: tests/validation/test_verification.py."""

import numpy as np
import pytest

from rubgen.fem.disk import assemble_disk
from rubgen.machine import load_machine
from validation.verification.elements.plates import annulus, lowest, out_of_plane
from validation.verification.elements.spinning_disks import growth_constants, membrane_squares, rotating_displacement

U, V, W, TH_X, TH_Y, TH_Z = range(6)


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


def test_annular_plate_has_its_modes_in_pairs_but_those_without_nodal_diameters():
    model = assemble_disk(annulus(0.3, 0.1))
    squares = lowest(model.M, model.K, out_of_plane(model), 7)  # nodal diameters 1, 1, 0, 2, 2, 3, 3
    np.testing.assert_allclose(squares[[0, 3, 5]], squares[[1, 4, 6]], rtol=2e-8)
    assert squares[2] > 1.01 * squares[1]


def test_growth_of_a_rotating_disk_is_right_at_every_node():
    A, B, c = growth_constants(0.3)
    model = assemble_disk(annulus(0.3, 0.1))
    q = rotating_displacement(model).reshape(-1, 6)
    r = np.linalg.norm(model.mesh.nodes, axis=1)
    radial = np.einsum("ij,ij->i", q[:, :2], model.mesh.nodes) / r
    np.testing.assert_allclose(radial, A * r + B / r - c * r**3, atol=2e-4 * radial.max())


def test_uniform_motion_of_a_membrane_disk_has_no_frequency():
    squares = membrane_squares(3)
    assert abs(squares[0]) < 1e-10
    assert squares[1] == pytest.approx(squares[2], rel=5e-3)
