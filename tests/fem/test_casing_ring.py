"""The casing's full model against rings in closed form."""

import dataclasses
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from rubgen.errors import UserError
from rubgen.fem.casing import CasingModel, assemble_casing
from rubgen.machine.load import load_machine
from rubgen.machine.machine import Machine
from validation.verification.elements.rings import by_order, order_three, ring, ring_theory


@pytest.fixture(autouse=True, scope="module")
def one_blas_thread() -> Iterator[None]:
    """As in every run: `rubgen.reduction.reduce` sees to it."""
    with threadpool_limits(1, user_api="blas"):
        yield


def machine(**casing: Any) -> Machine:
    preset = load_machine("zeng2019")
    return dataclasses.replace(preset, casing=dataclasses.replace(preset.casing, **casing))


@pytest.mark.parametrize(("radial", "tangential"), [(5e4, 5e4), (2e5, 5e4)])
def test_extensible_ring_on_elastic_foundation(radial: float, tangential: float) -> None:
    orders, expected, found = zip(*by_order(ring(radial, tangential), extensible=True), strict=True)
    assert orders == (0, 1, 2, 3, 4, 5)
    np.testing.assert_allclose(found, expected, rtol=5e-4)


def test_frequencies_tend_to_those_of_the_ring() -> None:
    # Springs of 100 N/m a node (180 nodes) leave order 3 to the ring's own bending. What is left is thin-ring theory:
    # shear and rotary inertia are (n h / R)^2, 4e-5 at order 3.
    coarse, fine = order_three(120), order_three(240)
    assert fine + (fine - coarse) / 3 == pytest.approx(ring_theory(ring(100.0, 100.0), 3, extensible=True), rel=1e-4)


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
