"""Eight-node Mindlin-Reissner shell element, flat in the plane z = 0, six DoFs a node (u, v, w, th_x, th_y, th_z).

A point at height z moves by (u + z th_y, v - z th_x, w). Everything is integrated for all elements at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rubgen.arrays import FloatArray, IntArray, SparseMatrix
from rubgen.machine import Material

SHEAR_CORRECTION = 5.0 / 6.0
# (xi, eta) of the element's nodes: four corners counter-clockwise, then the midsides between them.
_XI = np.array([-1.0, 1.0, 1.0, -1.0, 0.0, 1.0, 0.0, -1.0])
_ETA = np.array([-1.0, -1.0, 1.0, 1.0, -1.0, 0.0, 1.0, 0.0])


@dataclass(frozen=True)
class ShellMesh:
    """Nodes (n, 2) in m, elements (e, 8) as in the order of serendipity nodes, thickness in m at points (..., 2)."""

    nodes: FloatArray
    elements: IntArray
    thickness: Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class _Quadrature:
    """Values at the points q of every element e: N (q, 8), dN/d(x, y) (e, q, 8, 2), h (e, q), dA (e, q)."""

    N: FloatArray
    gradient: FloatArray
    thickness: FloatArray
    area: FloatArray


def serendipity(xi: FloatArray, eta: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Shape functions N (q, 8) and their derivatives (q, 8, 2) by xi, eta at the points (q,) of the square [-1, 1]^2.

    Corners: (1 + a)(1 + b)(a + b - 1)/4 with a = xi xi_i, b = eta eta_i; midsides (1 - xi^2)(1 + b)/2 and so on
    (Zienkiewicz and Taylor, The Finite Element Method, serendipity family).
    """
    x, y = xi[:, None], eta[:, None]
    a, b = x * _XI, y * _ETA
    corner = (1 + a) * (1 + b) * (a + b - 1) / 4
    corner_x = _XI * (1 + b) * (2 * a + b) / 4
    corner_y = _ETA * (1 + a) * (2 * b + a) / 4
    along_xi, along_eta = (1 - x**2) * (1 + b) / 2, (1 + a) * (1 - y**2) / 2
    N = np.where(_XI == 0, along_xi, np.where(_ETA == 0, along_eta, corner))
    N_x = np.where(_XI == 0, -x * (1 + b), np.where(_ETA == 0, _XI * (1 - y**2) / 2, corner_x))
    N_y = np.where(_XI == 0, _ETA * (1 - x**2) / 2, np.where(_ETA == 0, -y * (1 + a), corner_y))
    return N, np.stack([N_x, N_y], axis=-1)


def shell_stiffness(mesh: ShellMesh, material: Material) -> SparseMatrix:
    """Elastic stiffness (6 n, 6 n): membrane, bending and drilling by 3 x 3 points, transverse shear by 2 x 2.

    Strains: u_x, v_y, u_y + v_x; curvatures th_y,x, -th_x,y, th_y,y - th_x,x; shear w_x + th_y, w_y - th_x with the
    correction 5/6. Drilling: energy G h (th_z - (v_x - u_y)/2)^2 / 2 per area; 3 x 3 shear would lock, and a drilling
    stiffness far below G makes the joint of a blade too soft.
    """
    full, reduced = _quadrature(mesh, 3), _quadrature(mesh, 2)
    D = _plane_stress(material)
    G = material.shear_modulus_pa
    h = full.thickness
    K = _quadratic(_in_plane_strain(full), D, h * full.area)
    K += _quadratic(_curvature(full), D, h**3 / 12 * full.area)
    K += _quadratic(_drilling(full), np.array([[G]]), h * full.area)
    K += _quadratic(_shear_strain(reduced), SHEAR_CORRECTION * G * np.eye(2), reduced.thickness * reduced.area)
    return _assemble(mesh, K)


def shell_mass(mesh: ShellMesh, material: Material) -> SparseMatrix:
    """Consistent mass (6 n, 6 n): rho h on translations, rotary inertia rho h^3/12 on th_x and th_y, none on th_z."""
    points = _quadrature(mesh, 3)
    rho_area = material.density_kg_per_m3 * points.area
    translation = np.einsum("qa,qb,eq->eab", points.N, points.N, rho_area * points.thickness)
    rotation = np.einsum("qa,qb,eq->eab", points.N, points.N, rho_area * points.thickness**3 / 12)
    return _assemble(mesh, _by_direction(translation, translation, translation, rotation, rotation))


def shell_stress_stiffness(mesh: ShellMesh, material: Material, displacement: FloatArray) -> SparseMatrix:
    """Stiffness (6 n, 6 n) from the plane stress that the membrane part of `displacement` (6 n,) in m causes.

    Energy h grad(d)^T sigma grad(d) / 2 for d = u, v, w, and the same of th_x, th_y with h^3/12, per area; sigma at
    the 3 x 3 points of the membrane stiffness, so that it balances the loads of those points exactly.
    """
    points = _quadrature(mesh, 3)
    nodal = displacement.reshape(-1, 6)[mesh.elements].reshape(len(mesh.elements), 48)
    strain = np.einsum("eqia,ea->eqi", _in_plane_strain(points), nodal)
    stress = strain @ _plane_stress(material)
    tensor = stress[..., [0, 2, 2, 1]].reshape(*stress.shape[:2], 2, 2)
    pulled = np.einsum("eqij,eqbj->eqbi", tensor, points.gradient)
    h = points.thickness
    translation = np.einsum("eqai,eqbi,eq->eab", points.gradient, pulled, h * points.area, optimize=True)
    rotation = np.einsum("eqai,eqbi,eq->eab", points.gradient, pulled, h**3 / 12 * points.area, optimize=True)
    return _assemble(mesh, _by_direction(translation, translation, translation, rotation, rotation))


def _quadrature(mesh: ShellMesh, order: int) -> _Quadrature:
    points, weights = np.polynomial.legendre.leggauss(order)
    xi, eta = (grid.ravel() for grid in np.meshgrid(points, points, indexing="ij"))
    N, dN = serendipity(xi, eta)
    corners = mesh.nodes[mesh.elements]
    jacobian = np.einsum("qak,eai->eqki", dN, corners)
    gradient = np.einsum("eqik,qak->eqai", np.linalg.inv(jacobian), dN)
    area = np.linalg.det(jacobian) * np.outer(weights, weights).ravel()
    return _Quadrature(N, gradient, mesh.thickness(np.einsum("qa,eai->eqi", N, corners)), area)


def _plane_stress(material: Material) -> FloatArray:
    nu = material.poisson_ratio
    D: FloatArray = np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
    D *= material.youngs_modulus_pa / (1 - nu**2)
    return D


def _rows(points: _Quadrature, rows: int) -> FloatArray:
    return np.zeros((*points.area.shape, rows, 8, 6))


def _in_plane_strain(points: _Quadrature) -> FloatArray:
    B, g = _rows(points, 3), points.gradient
    B[:, :, 0, :, 0] = B[:, :, 2, :, 1] = g[..., 0]
    B[:, :, 1, :, 1] = B[:, :, 2, :, 0] = g[..., 1]
    return B.reshape(*B.shape[:3], 48)


def _curvature(points: _Quadrature) -> FloatArray:
    B, g = _rows(points, 3), points.gradient
    B[:, :, 0, :, 4] = g[..., 0]
    B[:, :, 1, :, 3] = -g[..., 1]
    B[:, :, 2, :, 4] = g[..., 1]
    B[:, :, 2, :, 3] = -g[..., 0]
    return B.reshape(*B.shape[:3], 48)


def _shear_strain(points: _Quadrature) -> FloatArray:
    B, g = _rows(points, 2), points.gradient
    B[:, :, :, :, 2] = g.swapaxes(2, 3)
    B[:, :, 0, :, 4] = points.N
    B[:, :, 1, :, 3] = -points.N
    return B.reshape(*B.shape[:3], 48)


def _drilling(points: _Quadrature) -> FloatArray:
    B, g = _rows(points, 1), points.gradient
    B[:, :, 0, :, 5] = points.N
    B[:, :, 0, :, 1] = -g[..., 0] / 2
    B[:, :, 0, :, 0] = g[..., 1] / 2
    return B.reshape(*B.shape[:3], 48)


def _quadratic(B: FloatArray, D: FloatArray, weight: FloatArray) -> FloatArray:
    """Integral of B^T D B for every element: (e, 48, 48)."""
    e, q, rows, n = B.shape
    DB = np.einsum("ij,eqjb,eq->eqib", D, B, weight, optimize=True)
    integral: FloatArray = B.reshape(e, q * rows, n).swapaxes(1, 2) @ DB.reshape(e, q * rows, n)
    return integral


def _by_direction(*blocks: FloatArray) -> FloatArray:
    """Element matrices (e, 48, 48) of nodal blocks (e, 8, 8), one for each DoF from u on."""
    full = np.zeros((len(blocks[0]), 8, 6, 8, 6))
    for i, block in enumerate(blocks):
        full[:, :, i, :, i] = block
    return full.reshape(-1, 48, 48)


def _assemble(mesh: ShellMesh, matrices: FloatArray) -> SparseMatrix:
    dof = (6 * mesh.elements[:, :, None] + np.arange(6)).reshape(-1, 48)
    rows, columns = np.repeat(dof, 48, axis=1), np.tile(dof, (1, 48))
    size = 6 * len(mesh.nodes)
    matrix = sp.coo_array((matrices.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size)).tocsr()
    matrix.eliminate_zeros()
    return matrix
