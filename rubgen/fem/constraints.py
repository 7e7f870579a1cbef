"""Penalty couplings of the blisk, disk centre to bore and blade root to rim; its springs; direct solves.

O_d is the disk centre.
"""

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import SuperLU, splu

from rubgen.arrays import FloatArray, IntArray, SparseMatrix
from rubgen.machine import DiskSupport


def rigid_rows(arm: FloatArray) -> FloatArray:
    """Return rows T (n, 6, 12) of the constraint T [q_O, q_i] = 0 that ties n nodes rigidly to O_d.

    `arm` (n, 2) are X and Y of the nodes from O_d, m. q_O and q_i are u, v, w, th_X, th_Y, th_Z of O_d and of node i.
    The rows are, in this order, u_i - u_O + Y th_Z = 0, v_i - v_O - X th_Z = 0, w_i - w_O - Y th_X + X th_Y = 0 with
    the rotations of O_d, and th_i - th_O = 0 for each rotation (Zeng et al. 2019, Eq. 1).
    """
    x, y = arm[:, 0], arm[:, 1]
    T = np.zeros((len(arm), 6, 12))
    T[:, :, 6:], T[:, :, :6] = np.eye(6), -np.eye(6)
    T[:, 0, 5], T[:, 1, 5] = y, -x
    T[:, 2, 3], T[:, 2, 4] = -y, x
    return T


def rigid_link(arm: FloatArray, node_dof: IntArray, centre_dof: IntArray, size: int) -> SparseMatrix:
    """Return the constraint rows T (6 n, size) of a rigid link between O_d and n nodes, as a sparse matrix.

    The rows of `rigid_rows` stand node after node. The penalty stiffness is k_p T^T T, and the force of the link on
    node i is -k_p T_i q.

    - arm (n, 2): X and Y of the nodes from O_d, m.
    - node_dof (n, 6), centre_dof (6,): indices of the DoFs of the nodes and of O_d.
    - size: number of all DoFs.
    """
    rows = rigid_rows(arm)
    columns = np.concatenate([np.broadcast_to(centre_dof, node_dof.shape), node_dof], axis=1)
    return _sparse_rows(rows, columns, size)


def link_stress_stiffness(arm: FloatArray, force: FloatArray) -> FloatArray:
    """Return the geometric stiffness (6, 6) of O_d from the steady forces in a rigid link; only its rotations have one.

    - arm (n, 2): positions r_i of the nodes from O_d, m.
    - force (n, 3): forces F_i of the link on the nodes, N.

    It is the second order of the link's rotation: a rotation th moves the end of an arm by th x r + th x (th x r) / 2.
    The second-order energy is E2 = sum F_i . th x (th x r_i) / 2, and K = sum [(F r^T + r F^T) / 2 - (F . r) I] on the
    rotations. Without it the gyroscopic terms of the whole blisk are wrong.
    """
    r = np.column_stack([arm, np.zeros(len(arm))])
    product = force.T @ r
    K = np.zeros((6, 6))
    K[3:, 3:] = (product + product.T) / 2 - np.trace(product) * np.eye(3)
    return K


def blade_rotation(angle: float) -> FloatArray:
    """Return T_k (6, 6), which turns the DoFs of a node from the axes of a blade at polar `angle` (rad) to o-xyz.

    Displacements and rotations are turned in the same way.
    """
    c, s = np.cos(angle), np.sin(angle)
    T = np.zeros((6, 6))
    T[:3, :3] = T[3:, 3:] = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]
    return T


def rim_joint(angle: FloatArray, rim_dof: IntArray, root_dof: IntArray, size: int) -> SparseMatrix:
    """Return the constraint rows (6 n, size) that join blade roots to rim nodes: q_rim - T_k q_root = 0.

    The penalty stiffness is k_p [I -T_k]^T [I -T_k] (Zeng et al. 2019).

    - angle (n,): polar angles of the blades, rad.
    - rim_dof, root_dof (n, 6): indices of the DoFs of rim nodes and blade roots.
    - size: number of all DoFs.
    """
    rows = np.stack([np.hstack([np.eye(6), -blade_rotation(a)]) for a in angle])
    return _sparse_rows(rows, np.concatenate([rim_dof, root_dof], axis=1), size)


def _sparse_rows(rows: FloatArray, columns: IntArray, size: int) -> SparseMatrix:
    n, m, width = rows.shape
    row = np.repeat(np.arange(n * m), width)
    column = np.broadcast_to(columns[:, None, :], rows.shape).ravel()
    matrix = sp.coo_array((rows.ravel(), (row, column)), shape=(n * m, size)).tocsr()
    matrix.eliminate_zeros()
    return matrix


def factorize(K: SparseMatrix) -> SuperLU:
    """Factorise a symmetric positive definite stiffness as LU, ordered for symmetric matrices, without pivoting.

    Raises RuntimeError for an exactly singular matrix.
    """
    return splu(sp.csc_array(K), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


def support_stiffness(support: DiskSupport) -> FloatArray:
    """Return the spring constants (6,) of O_d: x, y, z in N/m, rotations about x, y, z in N m/rad."""
    lateral, tilt = support.lateral_stiffness_n_per_m, support.tilt_stiffness_nm_per_rad
    axial, torsion = support.axial_stiffness_n_per_m, support.torsion_stiffness_nm_per_rad
    return np.array([lateral, lateral, axial, tilt, tilt, torsion])


def on_springs(K: SparseMatrix, stiffness: FloatArray) -> SparseMatrix:
    """Return K with the spring constants `stiffness` (6,) added to its first six DoFs, the DoFs of O_d."""
    diagonal = np.zeros(K.shape[0])
    diagonal[:6] = stiffness
    return (K + sp.diags_array(diagonal)).tocsr()


class FixedCentreStiffness:
    """The blisk's K on its axial, tilt and torsion springs, with x and y of O_d fixed at zero. It is factorised once.

    By symmetry the centrifugal load of two or more equal blades does not push O_d sideways. The steady state is
    therefore the same for any lateral stiffness.
    """

    def __init__(self, K: SparseMatrix, support: DiskSupport) -> None:
        self.K = on_springs(K, support_stiffness(support))
        self._factor = factorize(self.K[2:, 2:])

    def solve(self, load: FloatArray) -> FloatArray:
        """Return the displacement (n,) under `load` (n,) in N and N m. Its first two components are zero."""
        return np.concatenate([np.zeros(2), self._factor.solve(load[2:])])
