"""The casing's full model against rings in closed form."""

import dataclasses
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh
from threadpoolctl import threadpool_limits

from rubgen.errors import UserError
from rubgen.fem.casing import CasingModel, assemble_casing, element_matrices
from rubgen.machine.load import load_machine
from rubgen.machine.machine import Machine


@pytest.fixture(autouse=True, scope="module")
def one_blas_thread() -> Iterator[None]:
    """As in every run: `rubgen.reduction.reduce` sees to it."""
    with threadpool_limits(1, user_api="blas"):
        yield


def machine(**casing: Any) -> Machine:
    preset = load_machine("zeng2019")
    return dataclasses.replace(preset, casing=dataclasses.replace(preset.casing, **casing))


def frequencies(model: CasingModel, count: int) -> np.ndarray:
    eigenvalues = eigh(model.K.toarray(), model.M.toarray(), eigvals_only=True, subset_by_index=[0, count - 1])
    return np.asarray(np.sqrt(eigenvalues))


def ring_squares(m: Machine, radial: float, tangential: float, extensible: bool) -> np.ndarray:
    """Omega^2 of a thin circular ring, the lowest eleven: order 0 (turning) once, others twice; springs in N/m a node.

    Inextensible: [E I n^2 (n^2 - 1)^2 / R^4 + k_r n^2 + k_t] / [rho A (n^2 + 1)]. Extensible: the lower root with
    energies E A (v' + w)^2 / R^2 and E I (w'' - v')^2 / R^4.
    """
    c = m.casing
    R = m.casing_mean_radius_m + c.thickness_m / 2
    E, area, inertia = c.material.youngs_modulus_pa, c.width_m * c.thickness_m, c.width_m * c.thickness_m**3 / 12
    mass = c.material.density_kg_per_m3 * area
    k_r, k_t = (c.nodes * k / (2 * np.pi * R) for k in (radial, tangential))
    squares = []
    for n in range(20):
        if extensible:
            membrane, bend = E * area / R**2, E * inertia / R**4
            cross = membrane * n + bend * n**3
            K = [[membrane + bend * n**4 + k_r, cross], [cross, (membrane + bend) * n**2 + k_t]]
            square = np.linalg.eigvalsh(K)[0] / mass
        else:
            square = (E * inertia * n**2 * (n**2 - 1) ** 2 / R**4 + k_r * n**2 + k_t) / (mass * (n**2 + 1))
        squares += [square] * (1 if n == 0 else 2)
    return np.sort(squares)[:11]


def test_inextensible_ring_on_elastic_foundation() -> None:
    # Inextensibility needs springs soft against E A / R^2: 5 N/m a node, one 1e-6th of it. The rest of the
    # deviation is the polygon of 180 sides, (2 pi / 180)^2 / 4 = 3e-4.
    m = machine(ovality_m=0.0, radial_support_stiffness_n_per_m=5.0, circumferential_support_stiffness_n_per_m=3.0)
    expected = np.sqrt(ring_squares(m, 5.0, 3.0, extensible=False))
    np.testing.assert_allclose(frequencies(assemble_casing(m), 11), expected, rtol=5e-4)


@pytest.mark.parametrize(("radial", "tangential"), [(5e4, 5e4), (2e5, 5e4), (5e4, 2e5)])
def test_extensible_ring_on_elastic_foundation(radial: float, tangential: float) -> None:
    m = machine(
        ovality_m=0.0,
        radial_support_stiffness_n_per_m=radial,
        circumferential_support_stiffness_n_per_m=tangential,
    )
    expected = np.sqrt(ring_squares(m, radial, tangential, extensible=True))
    np.testing.assert_allclose(frequencies(assemble_casing(m), 11), expected, rtol=5e-4)


def test_second_order_convergence_to_the_ring() -> None:
    # Springs of 100 N/m a node (180 nodes) leave orders 3, 4, 5 to the ring's own bending.
    f = []
    for nodes in (60, 120, 240):
        k = 100.0 * 180 / nodes
        m = machine(
            ovality_m=0.0,
            nodes=nodes,
            radial_support_stiffness_n_per_m=k,
            circumferential_support_stiffness_n_per_m=k,
        )
        f.append(frequencies(assemble_casing(m), 11)[[5, 7, 9]])
    np.testing.assert_allclose(np.log2((f[0] - f[1]) / (f[1] - f[2])), 2.0, atol=0.05)
    limit = f[2] + (f[2] - f[1]) / 3
    # What is left is thin-ring theory: shear and rotary inertia are (n h / R)^2, 1e-4 at order 5.
    np.testing.assert_allclose(limit, np.sqrt(ring_squares(m, k, k, extensible=True))[[5, 7, 9]], rtol=1e-4)


@pytest.fixture(scope="module")
def oval() -> CasingModel:
    return assemble_casing(machine(ovality_m=20e-3, lobes=3, lobe_angle_deg=20.0))


def test_rigid_motion_of_the_ring_costs_no_energy(oval: CasingModel) -> None:
    x, y = oval.nodes_xy.T
    zero, one = np.zeros_like(x), np.ones_like(x)
    motions = np.array([np.column_stack(m).ravel() for m in ([one, zero, zero], [zero, one, zero], [-y, x, one])])
    assert np.abs(motions @ oval.K_ring).max() < 1e-11 * np.abs(oval.K_ring).max()
    eigenvalues = np.linalg.eigvalsh(oval.K_ring.toarray())
    assert eigenvalues[3] > 1e3 * np.abs(eigenvalues[:3]).max()


def test_mass_and_polar_inertia(oval: CasingModel) -> None:
    m = machine(ovality_m=20e-3, lobes=3, lobe_angle_deg=20.0)
    theta = 2 * np.pi * np.arange(4096) / 4096
    wave = 3 * (theta - np.deg2rad(20.0))
    r = m.casing_mean_radius_m + m.casing.thickness_m / 2 - 10e-3 * np.cos(wave)
    ds = np.hypot(r, 30e-3 * np.sin(wave)) * 2 * np.pi / 4096
    line = 7850.0 * m.casing.width_m * m.casing.thickness_m
    x, y = oval.nodes_xy.T
    shift = np.column_stack([np.ones_like(x), 0 * x, 0 * x]).ravel()
    turn = np.column_stack([-y, x, np.ones_like(x)]).ravel()
    # The polygon of 180 sides is (2 pi / 180)^2 / 24 = 5e-5 shorter.
    assert shift @ oval.M @ shift == pytest.approx(line * ds.sum(), rel=1e-4)
    assert turn @ oval.M @ turn == pytest.approx(line * (r**2 * ds).sum(), rel=3e-4)


def test_an_element_that_turns_about_its_middle_has_the_inertia_of_the_solid() -> None:
    material, width, thickness, length = machine().casing.material, 0.03, 0.02, 0.05
    _, mass = element_matrices(material, width, thickness, np.array([length]))
    turn = np.array([0, -length / 2, 1, 0, length / 2, 1])
    solid = material.density_kg_per_m3 * width * thickness * length * (length**2 + thickness**2) / 12
    assert turn @ mass[0] @ turn == pytest.approx(solid, rel=1e-12)


def test_springs_resist_along_the_polar_directions() -> None:
    m = machine(radial_support_stiffness_n_per_m=7e4, circumferential_support_stiffness_n_per_m=3e4)
    K = assemble_casing(m).K_supports.toarray()
    theta = np.deg2rad(60.0)
    block = K[90:92, 90:92]  # node 30 of 180
    e_r, e_t = np.array([np.cos(theta), np.sin(theta)]), np.array([-np.sin(theta), np.cos(theta)])
    np.testing.assert_allclose([block @ e_r, block @ e_t], [7e4 * e_r, 3e4 * e_t], rtol=1e-12)
    shift = np.tile([1.0, 0, 0], 180)
    assert shift @ K @ shift == pytest.approx(180 * (7e4 + 3e4) / 2)
    assert not K[2::3].any()


def test_smallest_radius_lies_at_the_lobe_angle_with_the_clearance_to_the_tips() -> None:
    m = machine(ovality_m=6e-3, lobes=2, lobe_angle_deg=30.0)
    model = assemble_casing(m)
    inner = np.hypot(*model.nodes_xy.T) - m.casing.thickness_m / 2
    assert np.argmin(inner) % 90 == 15  # at 30 and 210 degrees
    assert inner.min() == pytest.approx(m.tip_radius_m + m.casing.clearance_m, rel=1e-12)
    assert np.ptp(inner) == pytest.approx(6e-3, rel=1e-9)


@pytest.mark.parametrize(
    ("nodes", "lobes", "nearest"), [(181, 2, 180), (182, 2, 184), (180, 8, 176), (100, 3, 96), (14, 5, 20)]
)
def test_mesh_that_breaks_the_symmetry_is_refused(nodes: int, lobes: int, nearest: int) -> None:
    with pytest.raises(UserError) as error:
        assemble_casing(machine(nodes=nodes, lobes=lobes))
    message = str(error.value)
    assert f"casing.nodes = {nodes}" in message
    assert f"casing.lobes = {lobes}" in message
    assert f"take {nearest}" in message
    assemble_casing(machine(nodes=nearest, lobes=lobes))
