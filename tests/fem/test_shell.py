"""The shell element: interpolation, patch tests, rigid motions, locking, convergence."""

import numpy as np
import pytest
from scipy.linalg import null_space
from scipy.sparse.linalg import spsolve

from rubgen.fem.shell import shell_stiffness, shell_stress_stiffness
from rubgen.fem.shell_strains import ShellMesh, serendipity
from rubgen.machine import Material
from validation.verification.elements.plates import clamped_centre_deflection, navier_frequency, supported_frequency

STEEL = Material(youngs_modulus_pa=2.06e11, poisson_ratio=0.3, density_kg_per_m3=7850.0)
NU = STEEL.poisson_ratio
U, V, W, TH_X, TH_Y, TH_Z = range(6)


def rectangle(nx, ny, size=1.0, thickness=0.1, distort=0.0, shear=0.0):
    """nx x ny elements; interior corners moved at random by `distort`, then sheared, midsides in the middle."""
    grid = np.stack(np.meshgrid(np.linspace(0, size, nx + 1), np.linspace(0, size, ny + 1), indexing="ij"), axis=-1)
    moves = np.random.default_rng(1).uniform(-distort, distort, grid.shape) * size / max(nx, ny)
    grid[1:-1, 1:-1] += moves[1:-1, 1:-1]
    grid[..., 0] += shear * grid[..., 1]
    nodes, numbers, elements = [], {}, []

    def number(point):
        key = tuple(np.round(point, 12))
        if key not in numbers:
            numbers[key] = len(nodes)
            nodes.append(point)
        return numbers[key]

    for i in range(nx):
        for j in range(ny):
            corners = [grid[i, j], grid[i + 1, j], grid[i + 1, j + 1], grid[i, j + 1]]
            midsides = [(corners[k] + corners[(k + 1) % 4]) / 2 for k in range(4)]
            elements.append([number(p) for p in corners + midsides])
    return ShellMesh(np.array(nodes), np.array(elements), lambda p: np.full(p.shape[:-1], thickness))


def on_boundary(mesh, size, shear=0.0):
    x, y = mesh.nodes[:, 0] - shear * mesh.nodes[:, 1], mesh.nodes[:, 1]
    return np.isclose(x, 0) | np.isclose(x, size) | np.isclose(y, 0) | np.isclose(y, size)


def dof(nodes, *directions):
    return (6 * nodes[:, None] + np.array(directions)).ravel()


def solve_inside(mesh, exact, size=1.0, shear=0.0):
    """Displacement that the interior takes when the boundary is given the exact field."""
    K = shell_stiffness(mesh, STEEL)
    fixed = np.zeros(K.shape[0], bool)
    fixed[dof(np.flatnonzero(on_boundary(mesh, size, shear)), *range(6))] = True
    q = np.where(fixed, exact.ravel(), 0.0)
    q[~fixed] = spsolve(K[~fixed][:, ~fixed].tocsc(), -(K @ q)[~fixed])
    return q.reshape(-1, 6)


def test_shape_functions_interpolate_and_their_derivatives_match_differences():
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0.0]])
    np.testing.assert_allclose(serendipity(*corners.T)[0], np.eye(8), atol=1e-15)
    xi, eta = np.random.default_rng(2).uniform(-1, 1, (2, 9))
    N, dN = serendipity(xi, eta)
    np.testing.assert_allclose(N.sum(axis=1), 1.0, rtol=1e-14)
    step = 1e-6
    by_xi = (serendipity(xi + step, eta)[0] - serendipity(xi - step, eta)[0]) / (2 * step)
    by_eta = (serendipity(xi, eta + step)[0] - serendipity(xi, eta - step)[0]) / (2 * step)
    np.testing.assert_allclose(dN, np.stack([by_xi, by_eta], axis=-1), atol=1e-9)


def test_membrane_patch_of_distorted_elements_holds_every_linear_field():
    mesh = rectangle(3, 3, distort=0.3)
    x, y = mesh.nodes.T
    exact = np.zeros((len(x), 6))
    exact[:, U], exact[:, V] = 1e-3 * (2 * x + 0.5 * y), 1e-3 * (-0.7 * x + 1.5 * y)
    exact[:, TH_Z] = 1e-3 * (-0.7 - 0.5) / 2  # (v_x - u_y) / 2
    np.testing.assert_allclose(solve_inside(mesh, exact), exact, atol=1e-15)


def test_bending_patch_of_skewed_elements_holds_every_constant_curvature():
    mesh = rectangle(3, 3, shear=0.4)
    x, y = mesh.nodes.T
    exact = np.zeros((len(x), 6))
    exact[:, W] = 1e-3 * (x**2 + 0.6 * x * y - 0.8 * y**2)
    exact[:, TH_Y] = -1e-3 * (2 * x + 0.6 * y)  # th_y = -w_x
    exact[:, TH_X] = 1e-3 * (0.6 * x - 1.6 * y)  # th_x = w_y
    np.testing.assert_allclose(solve_inside(mesh, exact, shear=0.4), exact, atol=2e-15)


@pytest.mark.parametrize("field", ["stretch", "drilling", "curvature"])
def test_energy_of_unit_strain(field):
    E, h = STEEL.youngs_modulus_pa, 0.1
    mesh = rectangle(3, 2, shear=0.4) if field == "curvature" else rectangle(3, 2, distort=0.3)
    q = np.zeros((len(mesh.nodes), 6))
    x = mesh.nodes[:, 0]
    if field == "stretch":
        q[:, U] = x
        expected = E * h / (1 - NU**2) / 2
    elif field == "curvature":
        q[:, W], q[:, TH_Y] = -(x**2) / 2, x
        expected = E * h**3 / 12 / (1 - NU**2) / 2
    else:
        q[:, TH_Z] = 1.0
        expected = E / (2 * (1 + NU)) * h / 2
    assert q.ravel() @ (shell_stiffness(mesh, STEEL) @ q.ravel()) / 2 == pytest.approx(expected, rel=1e-12)


def test_only_the_six_rigid_motions_cost_no_energy():
    mesh = rectangle(3, 3, distort=0.3)
    K = shell_stiffness(mesh, STEEL).toarray()
    squares = np.linalg.eigvalsh(K)
    assert np.count_nonzero(squares < 1e-10 * squares[-1]) == 6
    x, y = mesh.nodes.T
    rigid = np.zeros((len(x), 6, 6))
    rigid[:, :, :] = np.eye(6)
    rigid[:, U, TH_Z], rigid[:, V, TH_Z] = -y, x
    rigid[:, W, TH_X], rigid[:, W, TH_Y] = y, -x
    rigid = rigid.reshape(-1, 6)
    assert np.abs(K @ rigid).max() < 1e-14 * squares[-1]
    overlap = np.linalg.norm(null_space(K, rcond=1e-10).T @ np.linalg.qr(rigid)[0])
    assert overlap == pytest.approx(np.sqrt(6), rel=1e-9)


@pytest.mark.parametrize("slenderness", [1e-3, 1e-4, 1e-5])
def test_thin_clamped_plate_does_not_lock(slenderness):
    # 0.0012653 (Timoshenko, Woinowsky-Krieger). Locking would make the coarse plate ever stiffer as it gets thinner.
    assert clamped_centre_deflection(4, slenderness) == pytest.approx(0.0012653, rel=3e-2)
    assert clamped_centre_deflection(16, slenderness) == pytest.approx(0.0012653, rel=2e-3)


@pytest.mark.parametrize(("thickness", "order", "tolerance"), [(0.05, 4.0, 0.15), (0.1, 4.0, 0.4)])
def test_frequencies_of_a_plate_converge_with_order_four(thickness, order, tolerance):
    meshes = (6, 12, 24)
    errors = np.array([supported_frequency(n, thickness) / navier_frequency(thickness) - 1 for n in meshes])
    assert np.all(errors > 0)
    assert errors[-1] < 3e-6
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx(order, abs=tolerance)


def test_stress_stiffness_of_uniform_tension_is_tension_times_squared_slope():
    E, h = STEEL.youngs_modulus_pa, 0.1
    mesh = rectangle(3, 3, distort=0.3)
    stretched = np.zeros((len(mesh.nodes), 6))
    stretched[:, U], stretched[:, V] = mesh.nodes[:, 0], -NU * mesh.nodes[:, 1]  # sigma_x = E, sigma_y = 0
    K = shell_stress_stiffness(mesh, STEEL, stretched.ravel())
    for direction in (U, V, W, TH_Z):
        for slope in ((3.0, 0.0), (0.0, 3.0)):
            q = np.zeros((len(mesh.nodes), 6))
            q[:, direction] = mesh.nodes @ slope
            if direction == W:
                q[:, TH_X], q[:, TH_Y] = slope[1], -slope[0]
            expected = 0.0 if direction == TH_Z else E * h * slope[0] ** 2
            assert q.ravel() @ (K @ q.ravel()) == pytest.approx(expected, rel=1e-12, abs=E * 1e-12)


def test_stress_stiffness_of_a_bent_plate_has_the_slope_of_the_rotation():
    E, h = STEEL.youngs_modulus_pa, 0.1
    mesh = rectangle(3, 3, shear=0.4)
    q = np.zeros((len(mesh.nodes), 6))
    x = mesh.nodes[:, 0]
    q[:, U], q[:, V] = x, -NU * mesh.nodes[:, 1]
    K = shell_stress_stiffness(mesh, STEEL, q.ravel())
    q[:, :2] = 0.0
    q[:, W], q[:, TH_Y] = -(x**2) / 2, x
    x_squared = 1 / 3 + 0.4 / 2 + 0.4**2 / 3  # integral of (X + 0.4 Y)^2 over the unit square
    assert q.ravel() @ (K @ q.ravel()) == pytest.approx(E * (h * x_squared + h**3 / 12), rel=1e-12)
