"""Eight-node Mindlin-Reissner shell element, flat in the plane z = 0, six DoFs a node (u, v, w, th_x, th_y, th_z).

A point at height z moves by (u + z th_y, v - z th_x, w). All elements are integrated at once, except turned copies of
others (`ShellMesh.around`). Against shear locking th_x and th_y have a bubble besides the eight nodes (the heterosis
idea of Hughes and Cohen 1978). The bubble follows the nodes statically: q_54 = T q_48 in every matrix.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rubgen.arrays import FloatArray, SparseMatrix
from rubgen.fem.shell_strains import (
    BUBBLE_DOFS,
    ELEMENT_DOFS,
    ShellMesh,
    curvature,
    drilling,
    in_plane_strain,
    quadrature,
    shear_strain,
)
from rubgen.machine import Material

SHEAR_CORRECTION = 5.0 / 6.0
# Per node: e_z x on (u, v, w) and on (th_x, th_y, th_z).
SPIN = np.kron(np.eye(2), np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]))


@dataclass(frozen=True)
class ShellInertia:
    """Inertia matrices of n nodes, each (6 n, 6 n), kg and kg m2: mass M, Coriolis G (skew), spin softening S."""

    M: SparseMatrix
    G: SparseMatrix
    S: SparseMatrix


def shell_stiffness(mesh: ShellMesh, material: Material) -> SparseMatrix:
    """Assemble the elastic stiffness (6 n, 6 n) of a mesh.

    Membrane, bending and drilling are integrated at 3 x 3 points, transverse shear at 2 x 2. Strains: u_x, v_y, u_y +
    v_x; curvatures th_y,x, -th_x,y, th_y,y - th_x,x; shear w_x + th_y, w_y - th_x with the correction 5/6. Drilling:
    energy G h (th_z - (v_x - u_y)/2)^2 / 2 per area. A factor far below G would make the joint of a blade too soft.
    Square elements do not lock however thin; narrow sectors of a disk keep 1 % down to a thickness of a hundredth of
    the element. Tests: tests/fem/test_shell.py, test_disk.py.
    """
    K = _element_stiffness(mesh.firsts, material)
    return _assemble(mesh, mesh.turned(_on_nodes(_following(K), K)))


def shell_inertia(mesh: ShellMesh, material: Material) -> ShellInertia:
    """Assemble the consistent inertia of a mesh: rho h on translations, rho h^3/12 on th_x and th_y, none on th_z.

    M = int rho N^T N is the mass. S = int rho N^T (1 - e_z e_z^T) N is M with zeros for w: it has the inertia of u, v,
    th_x and th_y. G = int rho N^T (e_z x N) = (e_z x) S, without the factor 2 Omega of the Coriolis force.
    """
    points, T = quadrature(mesh.firsts, 3), _following(_element_stiffness(mesh.firsts, material))
    rho_area = material.density_kg_per_m3 * points.area
    N = points.N * (np.arange(9) < 8)
    t = np.einsum("qa,qb,eq->eab", N, N, rho_area * points.thickness)
    r = np.einsum("qa,qb,eq->eab", points.N, points.N, rho_area * points.thickness**3 / 12)
    S = _by_direction(t, t, np.zeros_like(t), r, r)
    G = (np.kron(np.eye(9), SPIN) @ S).reshape(S.shape)
    M = _by_direction(t, t, t, r, r)
    return ShellInertia(*(_assemble(mesh, mesh.turned(_on_nodes(T, X))) for X in (M, G, S)))


def shell_stress_stiffness(mesh: ShellMesh, material: Material, displacement: FloatArray) -> SparseMatrix:
    """Assemble the geometric stiffness (6 n, 6 n) from the membrane stress of `displacement` (6 n,), m and rad.

    Energy h grad(d)^T sigma grad(d) / 2 for d = u, v, w, and the same for th_x, th_y with h^3/12, per area. sigma is
    taken at the 3 x 3 points of the membrane stiffness, so that it balances the loads of these points exactly.
    """
    points, T = quadrature(mesh, 3), mesh.turned(_following(_element_stiffness(mesh.firsts, material)))
    nodal = displacement.reshape(-1, 6)[mesh.elements].reshape(len(mesh.elements), 48)
    strain = np.einsum("eqia,ea->eqi", in_plane_strain(points)[..., :48], nodal)
    stress = strain @ _plane_stress(material)
    tensor = stress[..., [0, 2, 2, 1]].reshape(*stress.shape[:2], 2, 2)
    gradient = points.gradient * (np.arange(9) < 8)[:, None]
    h, area = points.thickness, points.area
    t = np.einsum("eqai,eqij,eqbj,eq->eab", gradient, tensor, gradient, h * area, optimize=True)
    r = np.einsum("eqai,eqij,eqbj,eq->eab", points.gradient, tensor, points.gradient, h**3 / 12 * area, optimize=True)
    return _assemble(mesh, _on_nodes(T, _by_direction(t, t, t, r, r)))


def _element_stiffness(mesh: ShellMesh, material: Material) -> FloatArray:
    full, reduced = quadrature(mesh, 3), quadrature(mesh, 2)
    D, G, h = _plane_stress(material), material.shear_modulus_pa, full.thickness
    K = _quadratic(in_plane_strain(full), D, h * full.area)
    K += _quadratic(curvature(full), D, h**3 / 12 * full.area)
    K += _quadratic(drilling(full), np.array([[G]]), h * full.area)
    K += _quadratic(shear_strain(reduced), SHEAR_CORRECTION * G * np.eye(2), reduced.thickness * reduced.area)
    return K


def _plane_stress(material: Material) -> FloatArray:
    nu = material.poisson_ratio
    D: FloatArray = np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
    D *= material.youngs_modulus_pa / (1 - nu**2)
    return D


def _quadratic(B: FloatArray, D: FloatArray, weight: FloatArray) -> FloatArray:
    """Return the integral of B^T D B for every element, (e, n, n)."""
    e, q, rows, n = B.shape
    DB = np.einsum("ij,eqjb,eq->eqib", D, B, weight, optimize=True)
    integral: FloatArray = B.reshape(e, q * rows, n).swapaxes(1, 2) @ DB.reshape(e, q * rows, n)
    return integral


def _following(K: FloatArray) -> FloatArray:
    """Return T (e, 54, 48), by which the bubble follows the nodes statically."""
    T = np.zeros((len(K), ELEMENT_DOFS, 48))
    T[:, :48] = np.eye(48)
    T[:, BUBBLE_DOFS] = -np.linalg.solve(K[:, BUBBLE_DOFS[:, None], BUBBLE_DOFS], K[:, BUBBLE_DOFS, :48])
    return T


def _by_direction(*blocks: FloatArray) -> FloatArray:
    """Return element matrices (e, 54, 54) of blocks (e, 9, 9), one for each DoF from u on."""
    full = np.zeros((len(blocks[0]), 9, 6, 9, 6))
    for i, block in enumerate(blocks):
        full[:, :, i, :, i] = block
    return full.reshape(-1, ELEMENT_DOFS, ELEMENT_DOFS)


def _on_nodes(T: FloatArray, matrices: FloatArray) -> FloatArray:
    """Return T^T X T (e, 48, 48): the matrices on the nodes only."""
    nodal: FloatArray = T.swapaxes(1, 2) @ matrices @ T
    return nodal


def _assemble(mesh: ShellMesh, nodal: FloatArray) -> SparseMatrix:
    dof = (6 * mesh.elements[:, :, None] + np.arange(6)).reshape(-1, 48)
    rows, columns = np.repeat(dof, 48, axis=1), np.tile(dof, (1, 48))
    size = 6 * len(mesh.nodes)
    matrix = sp.coo_array((nodal.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size)).tocsr()
    matrix.eliminate_zeros()
    return matrix
