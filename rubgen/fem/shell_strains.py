"""Interpolate displacements in the eight-node shell and compute strains at quadrature points, all elements at once."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray, IntArray

# (xi, eta) of the element's nodes: four corners counter-clockwise, then the midsides between them.
_XI = np.array([-1.0, 1.0, 1.0, -1.0, 0.0, 1.0, 0.0, -1.0])
_ETA = np.array([-1.0, -1.0, 1.0, 1.0, -1.0, 0.0, 1.0, 0.0])
# DoFs of an element: eight nodes and the bubble, six each; the bubble has th_x and th_y only.
ELEMENT_DOFS = 54
BUBBLE_DOFS = np.array([51, 52])


@dataclass(frozen=True)
class ShellMesh:
    """A mesh of eight-node shells: nodes (n, 2) in m, elements (e, 8) in the order of serendipity nodes.

    `thickness` returns the thickness in m at points (..., 2). Elements are in groups of `around`. The elements of a
    group are its first element turned about the origin by 0, 2 pi / around, 4 pi / around, ...
    """

    nodes: FloatArray
    elements: IntArray
    thickness: Callable[[FloatArray], FloatArray]
    around: int = 1

    @property
    def firsts(self) -> "ShellMesh":
        """The mesh of the first element of each group."""
        return ShellMesh(self.nodes, self.elements[:: self.around], self.thickness)

    def turned(self, firsts: FloatArray) -> FloatArray:
        """Return the matrices (e, 6 a, 6 b) of all elements, Z_j X Z_j^T, from X = `firsts` of the first elements.

        `firsts` is (groups, 6 a, 6 b). Z_j turns each node's DoFs to the position of element j of the group.
        """
        if self.around == 1:
            return firsts
        angle = (2 * np.pi * np.arange(self.around) / self.around)[:, None, None]
        c, s, X = np.cos(angle), np.sin(angle), firsts[:, None]
        out = np.empty((len(firsts), self.around, *firsts.shape[1:]))
        out[..., 0::3, :] = c * X[..., 0::3, :] - s * X[..., 1::3, :]
        out[..., 1::3, :] = s * X[..., 0::3, :] + c * X[..., 1::3, :]
        out[..., 2::3, :] = X[..., 2::3, :]
        x, y = out[..., 0::3].copy(), out[..., 1::3].copy()
        out[..., 0::3], out[..., 1::3] = c * x - s * y, s * x + c * y
        return out.reshape(-1, *firsts.shape[1:])


@dataclass(frozen=True)
class Quadrature:
    """Values at the quadrature points q of every element e: N (q, 9), dN/d(x, y) (e, q, 9, 2), h (e, q), dA (e, q).

    N are the shape functions, h the thickness in m, dA the area of the point in m2. The ninth function is the bubble (1
    - xi^2)(1 - eta^2); only the rotations have it.
    """

    N: FloatArray
    gradient: FloatArray
    thickness: FloatArray
    area: FloatArray


def serendipity(xi: FloatArray, eta: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return shape functions N (q, 8) and their derivatives (q, 8, 2) by xi, eta at points (q,) of [-1, 1]^2.

    The first four nodes are the corners, counter-clockwise from (-1, -1), the others the midsides, from (0, -1).
    Corners: (1 + a)(1 + b)(a + b - 1)/4 with a = xi xi_i, b = eta eta_i; midsides (1 - xi^2)(1 + b)/2 and (1 + a)(1 -
    eta^2)/2 (Zienkiewicz and Taylor, The Finite Element Method, serendipity family).
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


def quadrature(mesh: ShellMesh, order: int) -> Quadrature:
    """Evaluate shape functions, thickness and area at order x order Gauss points of each element."""
    points, weights = np.polynomial.legendre.leggauss(order)
    xi, eta = (grid.ravel() for grid in np.meshgrid(points, points, indexing="ij"))
    N, dN = serendipity(xi, eta)
    nodes = mesh.nodes[mesh.elements]
    jacobian = np.einsum("qak,eai->eqki", dN, nodes)
    thickness = mesh.thickness(np.einsum("qa,eai->eqi", N, nodes))
    bubble = (1 - xi**2) * (1 - eta**2)
    bubble_slope = np.stack([-2 * xi * (1 - eta**2), -2 * eta * (1 - xi**2)], axis=-1)
    N, dN = np.column_stack([N, bubble]), np.concatenate([dN, bubble_slope[:, None]], axis=1)
    gradient = np.einsum("eqik,qak->eqai", np.linalg.inv(jacobian), dN)
    area = np.linalg.det(jacobian) * np.outer(weights, weights).ravel()
    return Quadrature(N, gradient, thickness, area)


def in_plane_strain(points: Quadrature) -> FloatArray:
    """Return the rows (e, q, 3, 54) that multiply an element's DoFs to u_x, v_y, u_y + v_x."""
    B, g = _strain_rows(points, 3), points.gradient[:, :, :8]
    B[:, :, 0, :8, 0] = B[:, :, 2, :8, 1] = g[..., 0]
    B[:, :, 1, :8, 1] = B[:, :, 2, :8, 0] = g[..., 1]
    return B.reshape(*B.shape[:3], ELEMENT_DOFS)


def curvature(points: Quadrature) -> FloatArray:
    """Return the rows (e, q, 3, 54) that multiply an element's DoFs to th_y,x, -th_x,y, th_y,y - th_x,x.

    The DoFs are six of each of the eight nodes, then six of the bubble.
    """
    B, g = _strain_rows(points, 3), points.gradient
    B[:, :, 0, :, 4] = g[..., 0]
    B[:, :, 1, :, 3] = -g[..., 1]
    B[:, :, 2, :, 4] = g[..., 1]
    B[:, :, 2, :, 3] = -g[..., 0]
    return B.reshape(*B.shape[:3], ELEMENT_DOFS)


def shear_strain(points: Quadrature) -> FloatArray:
    """Return the rows (e, q, 2, 54) that multiply an element's DoFs to w_x + th_y, w_y - th_x."""
    B, g = _strain_rows(points, 2), points.gradient[:, :, :8]
    B[:, :, :, :8, 2] = g.swapaxes(2, 3)
    B[:, :, 0, :, 4] = points.N
    B[:, :, 1, :, 3] = -points.N
    return B.reshape(*B.shape[:3], ELEMENT_DOFS)


def drilling(points: Quadrature) -> FloatArray:
    """Return the row (e, q, 1, 54) that multiplies an element's DoFs to th_z - (v_x - u_y) / 2."""
    B, g = _strain_rows(points, 1), points.gradient[:, :, :8]
    B[:, :, 0, :8, 5] = points.N[:, :8]
    B[:, :, 0, :8, 1] = -g[..., 0] / 2
    B[:, :, 0, :8, 0] = g[..., 1] / 2
    return B.reshape(*B.shape[:3], ELEMENT_DOFS)


def _strain_rows(points: Quadrature, rows: int) -> FloatArray:
    """Return zero strain rows (e, q, rows, 9, 6): eight nodes and the bubble, six DoFs each."""
    return np.zeros((*points.area.shape, rows, 9, 6))
