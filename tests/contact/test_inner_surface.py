"""Contact on the casing's inner surface, half a thickness inside the ring's centre line."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse.linalg as spla

from rubgen.contact import casing_surface
from rubgen.contact.geometry import surface_modes
from rubgen.contact.geometry_kernels import casing_rows
from rubgen.errors import UserError
from rubgen.fem.casing import assemble_casing
from rubgen.machine import load_machine
from rubgen.reduction.casing import reduce_casing
from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import ContactLaw

OFFSET, NODES, NODE = ContactLaw(half_thickness=True), 36, 7


@pytest.fixture(scope="module")
def machine():
    preset = load_machine("zeng2019")
    return replace(preset, casing=replace(preset.casing, nodes=NODES, thickness_m=6e-3))


@pytest.fixture(scope="module")
def full_ring(machine):
    """The casing with all of its modes, so that nothing is lost in them, and its stiffness in them."""
    casing = reduce_casing(machine, 3 * NODES)
    modes = 3 * NODES
    system = SpinningSystem(
        speed=700.0,
        M=np.eye(5 + modes),
        C=np.zeros((5 + modes, 5 + modes)),
        K=np.eye(5 + modes),
        force=np.zeros(5 + modes),
        n_blades=1,
        n_casing=modes,
        tip_radius=machine.tip_radius_m,
        blade_angles=np.zeros(1),
        tip_static=np.zeros((1, 3)),
        surface=casing.surface,
        casing_modes=casing.modes_xy,
        lateral_stiffness=1.0,
        lateral_damping=0.0,
        casing_rotations=casing.rotations,
        half_thickness=machine.casing.thickness_m / 2,
    )
    return system, (2 * np.pi * casing.frequencies_hz) ** 2


def axes(angle):
    return np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])


def test_a_surface_point_moves_as_a_rigid_section_carries_it(full_ring):
    system, _ = full_ring
    q = np.random.default_rng(2).normal(size=system.n_casing)
    surface, rows = casing_surface(system, OFFSET), np.zeros((2, system.n_casing))
    for node in range(0, NODES, 5):
        e_r, _ = axes(2 * np.pi * node / NODES)
        arm = -system.half_thickness * e_r
        casing_rows(surface, 2 * np.pi * node / NODES + 1e-12, rows)
        turn = system.casing_rotations[node] @ q
        expected = system.casing_modes[node] @ q + turn * np.array([-arm[1], arm[0]])
        np.testing.assert_allclose(rows @ q, expected, rtol=1e-8)


def test_a_static_force_at_the_surface_turns_the_ring_as_force_and_moment_at_its_centre_line_do(machine, full_ring):
    """All modes = full model: B q / omega^2 against K u = [F, moment about the node] of the finite elements."""
    system, stiffness = full_ring
    angle = 2 * np.pi * NODE / NODES
    e_r, e_t = axes(angle)
    force = 300.0 * e_t - 2000.0 * e_r
    rows = np.zeros((2, system.n_casing))
    casing_rows(casing_surface(system, OFFSET), angle + 1e-13, rows)
    q = (rows.T @ force) / stiffness
    model = assemble_casing(machine)
    load = np.zeros(3 * NODES)
    load[3 * NODE : 3 * NODE + 2] = force
    load[3 * NODE + 2] = -machine.casing.thickness_m / 2 * 300.0
    exact = spla.spsolve(model.K.tocsc(), load).reshape(NODES, 3)
    size = np.abs(exact).max(axis=0)
    np.testing.assert_allclose(system.casing_modes @ q, exact[:, :2], atol=1e-7 * size[:2].max())
    np.testing.assert_allclose(system.casing_rotations @ q, exact[:, 2], atol=1e-7 * size[2])


def test_springs_bear_the_moment_of_friction_about_the_axis_at_the_inner_radius(machine, full_ring):
    """Moment equilibrium of the whole ring: sum of spring moments = F_t r, r the inner radius and not the ring's."""
    system, stiffness = full_ring
    angle, casing = 2 * np.pi * NODE / NODES, machine.casing
    _, e_t = axes(angle)
    nodes = assemble_casing(machine).nodes_xy
    moments = []
    for law in (OFFSET, ContactLaw()):
        rows = np.zeros((2, system.n_casing))
        casing_rows(casing_surface(system, law), angle + 1e-13, rows)
        u = system.casing_modes @ ((rows.T @ e_t) / stiffness)
        moments.append(casing.circumferential_support_stiffness_n_per_m * np.sum(nodes[:, 0] * u[:, 1]))
        moments[-1] -= casing.radial_support_stiffness_n_per_m * np.sum(nodes[:, 1] * u[:, 0])
    ring_radius = np.hypot(*nodes[NODE])
    assert moments == pytest.approx([ring_radius - casing.thickness_m / 2, ring_radius], rel=1e-7)


def test_off_by_default_and_refused_without_rotations(full_ring):
    system, _ = full_ring
    np.testing.assert_array_equal(surface_modes(system, ContactLaw()), system.casing_modes)
    with pytest.raises(UserError, match="half_thickness = true: the system holds no rotations"):
        casing_surface(replace(system, casing_rotations=None), OFFSET)
