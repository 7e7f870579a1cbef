"""The full blisk: couplings, rigid motions, cyclic symmetry, published frequencies."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.errors import UserError
from rubgen.fem.blisk import assemble_blisk, rigid_motions
from rubgen.fem.constraints import blade_rotation, link_stress_stiffness, rigid_rows
from rubgen.machine import load_machine
from validation.full_blisk import blisk_frequencies


@pytest.fixture(scope="module")
def machine():
    return load_machine("zeng2019")


@pytest.fixture(scope="module")
def preset(machine):
    return assemble_blisk(machine.disk, machine.blades, machine.disk_support)


@pytest.fixture(scope="module")
def small(machine):
    disk = replace(machine.disk, radial_elements=2, circumferential_elements=12)
    return assemble_blisk(disk, replace(machine.blades, count=6, elements=3), machine.disk_support)


def test_full_model_has_the_size_of_the_published_one(preset, machine):
    assert preset.M.shape[0] + 3 * machine.casing.nodes == 15018  # the paper's 15,021 has 181 casing nodes


def test_couplings_and_elements_let_the_whole_move_rigidly(preset):
    R = rigid_motions(preset)
    assert np.abs(R.T @ (preset.K @ R)).max() < 1e-10 * preset.penalty


def test_blades_move_rigidly_with_a_tilted_disk(preset):
    # A tip at polar angle phi rises by r sin(phi) when the blisk turns about x by one radian.
    R = rigid_motions(preset)
    rise = R[preset.tips[:, 2], 3]
    np.testing.assert_allclose(rise, 0.4 * np.sin(preset.angles), atol=1e-12)


def test_centrifugal_stiffness_on_rigid_motions_is_the_gyroscopic_one(preset):
    # K_sigma - S projected on rigid motions: -m, -m, 0, I_p - I_d, I_p - I_d, 0. Blades, disk and the link's
    # geometric term must all be there.
    R = rigid_motions(preset)
    inertia = np.diag(R.T @ (preset.M @ R))
    mass, diametral, polar = inertia[0], inertia[3], inertia[5]
    expected = np.diag([-mass, -mass, 0, polar - diametral, polar - diametral, 0])
    found = R.T @ ((preset.K_sigma - preset.S) @ R)
    np.testing.assert_allclose(found, expected, atol=1e-9 * mass)


def test_coriolis_and_centrifugal_forces_on_rigid_motions(small):
    """G v is the mass of the plane, S, on e_z x v: shifts, -r_perp, and for (0, -z, y), (z, 0, -x) the other tilt."""
    R = rigid_motions(small)
    S_R = small.S @ R
    expected = np.column_stack([S_R[:, 1], -S_R[:, 0], 0 * S_R[:, 2], S_R[:, 4], -S_R[:, 3], -small.f_c])
    np.testing.assert_allclose(small.G @ R, expected, atol=1e-13 * np.abs(small.G).max())
    assert np.abs(S_R[:, 3:5]).max() > 1e-6 * np.abs(small.G).max()
    # A shift brings -S shift alone: the steady stress is in equilibrium and does not feel it.
    A = small.K_sigma - small.S
    np.testing.assert_allclose(A @ R[:, :3], -S_R[:, :3], atol=1e-9 * np.abs(A).max())


def test_mass_properties_of_the_preset(preset, machine):
    inertia = np.einsum("ij,ij->j", rigid_motions(preset), preset.M @ rigid_motions(preset))
    blades, rho = machine.blades, machine.blades.material.density_kg_per_m3
    # A blade whose chord and thickness are linear: exact volume, and the second moment about Z by Simpson's rule.
    x = np.linspace(0, 1, 201)
    area = (blades.root_chord_m + (blades.tip_chord_m - blades.root_chord_m) * x) * (
        blades.root_thickness_m + (blades.tip_thickness_m - blades.root_thickness_m) * x
    )
    simpson = np.r_[1, np.tile([4, 2], 99), 4, 1] / 600
    blade_mass = rho * blades.length_m * simpson @ area
    disk_R = rigid_motions(preset)[6 : preset.disk_size]
    disk_mass = disk_R[:, 0] @ (preset.plate.M @ disk_R[:, 0])
    assert inertia[0] == pytest.approx(disk_mass + 36 * blade_mass, rel=1e-9)
    # Within 1 % of the independent model: 117.7 kg, 2.10 and 4.09 kg m2.
    np.testing.assert_allclose(inertia[[0, 3, 5]], [117.7, 2.10, 4.09], rtol=1e-2)


def test_the_blisk_looks_the_same_from_every_blade(small):
    # Turning the disk's DoFs by one blade pitch and renumbering nodes must leave the matrices as they are.
    n_c, pitch = 12, 2 * np.pi / 6
    order = [0]
    for start, ring in zip((0, 24, 36, 60, 72), (24, 12, 24, 12, 24), strict=True):
        order += list(1 + start + np.roll(np.arange(ring), -ring // 6))
    assert len(order) == 1 + len(small.plate.mesh.nodes) == 1 + 72 + 2 * n_c
    blade_nodes = 4
    order += list(len(order) + np.roll(np.arange(6 * blade_nodes), -blade_nodes))
    to = (6 * np.array(order)[:, None] + np.arange(6)).ravel()
    n_disk = small.disk_size // 6
    turn = np.eye(small.M.shape[0])
    back = blade_rotation(-pitch)
    for node in range(n_disk):
        turn[6 * node : 6 * node + 6, 6 * node : 6 * node + 6] = back
    for name in ("M", "G", "K", "S", "K_sigma"):
        X = getattr(small, name).toarray()
        np.testing.assert_allclose(turn @ X[np.ix_(to, to)] @ turn.T, X, atol=1e-9 * np.abs(X).max())


def test_link_term_is_the_second_order_work_of_its_forces():
    rng = np.random.default_rng(4)
    arm, force = rng.normal(size=(7, 2)), rng.normal(size=(7, 3))
    r = np.column_stack([arm, np.zeros(7)])
    th = rng.normal(size=3)
    work = np.sum(force * np.cross(th, np.cross(th, r))) / 2
    K = link_stress_stiffness(arm, force)
    assert th @ K[3:, 3:] @ th / 2 == pytest.approx(work, rel=1e-12)


def test_rigid_rows_vanish_on_rigid_motions_only():
    arm = np.array([[0.3, -0.7]])
    T = rigid_rows(arm)[0]
    th, shift = np.array([0.1, -0.2, 0.3]), np.array([1.0, 2.0, 3.0])
    node = shift + np.cross(th, [0.3, -0.7, 0.0])
    assert np.abs(T @ np.concatenate([shift, th, node, th])).max() < 1e-15
    assert np.linalg.matrix_rank(T) == 6


def test_full_model_lies_within_two_per_cent_of_the_published_frequencies(preset, machine):
    found = blisk_frequencies(preset, machine.disk_support, 42)
    published = [68.55, 68.55, 143.65, 143.65, 155.37, 164.43, 164.43, 210.60, 417.32]
    np.testing.assert_allclose(found[[0, 1, 2, 3, 4, 38, 39, 40, 41]], published, rtol=2e-2)
    np.testing.assert_allclose(found[[0, 2, 38]], found[[1, 3, 39]], rtol=1e-6)


def test_a_machine_that_cannot_be_meshed_is_refused(machine):
    with pytest.raises(UserError, match=r"circumferential_elements = 72: must be a multiple of blades.count = 35.* 70"):
        assemble_blisk(machine.disk, replace(machine.blades, count=35), machine.disk_support)
    with pytest.raises(ValueError, match=r"bore_radius_m = 0.3 must be below rim_radius_m = 0.25"):
        replace(machine.disk, bore_radius_m=0.3)
