"""Assemble the casing's full model: a closed ring of Timoshenko beams in its plane, on springs at its nodes."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.polynomial.legendre import leggauss

from rubgen.arrays import FloatArray, SparseMatrix
from rubgen.errors import UserError
from rubgen.fem.cross_sections import cowper_shear_coefficient
from rubgen.machine.machine import Casing, Machine, Material
from rubgen.machine.mesh import node_problem

# The mass integrand is of degree six in the length: four points are exact.
GAUSS_POINTS = 4


@dataclass(frozen=True, kw_only=True)
class CasingModel:
    """The casing in the inertial frame: 3 DoF a node (u along X, v along Y, phi about Z), node after node.

    `angles` (nodes,) are the polar angles in rad, equal steps from 0; `nodes_xy` (nodes, 2) the ring's centre line in
    m. `M`, `K_ring` and `K_supports` are (3 nodes, 3 nodes). `K_supports` are the springs to ground.
    """

    angles: FloatArray
    nodes_xy: FloatArray
    M: SparseMatrix
    K_ring: SparseMatrix
    K_supports: SparseMatrix

    @property
    def K(self) -> SparseMatrix:
        """Stiffness of the ring on its springs, (3 nodes, 3 nodes)."""
        return sp.csr_array(self.K_ring + self.K_supports)


def assemble_casing(machine: Machine, *, any_nodes: bool = False) -> CasingModel:
    """Assemble the full model of the machine's casing at rest.

    The centre line lies half a thickness outside the undeformed inner surface of `machine.casing`. Its nodes are at
    equal steps of polar angle, with straight uniform elements between them (exact statics, Friedman and Kosmatka 1993,
    without locking), Cowper's shear coefficient and rotary inertia. The springs act at each node along e_r and e_theta
    of its polar angle. The modulus is E of a beam, not E / (1 - nu^2) of a wide shell: the published model uses a beam.

    Raises UserError where the number of nodes is no multiple of 4 or no multiple of the number of lobes: any other mesh
    breaks the symmetry of the surface and adds orders to the response that the machine does not have. With `any_nodes`,
    for experiments, this is not checked.
    """
    casing = machine.casing
    problem = None if any_nodes else node_problem(casing)
    if problem:
        raise UserError(problem)
    angles = 2 * np.pi * np.arange(casing.nodes) / casing.nodes
    lobes = np.cos(casing.lobes * (angles - np.deg2rad(casing.lobe_angle_deg)))
    radius = machine.casing_mean_radius_m - casing.ovality_m / 2 * lobes + casing.thickness_m / 2
    nodes_xy = radius[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    chords = np.roll(nodes_xy, -1, axis=0) - nodes_xy
    lengths = np.hypot(chords[:, 0], chords[:, 1])
    to_local = _rotation(chords / lengths[:, None])
    stiffness, mass = element_matrices(casing.material, casing.width_m, casing.thickness_m, lengths)
    return CasingModel(
        angles=angles,
        nodes_xy=nodes_xy,
        M=_assemble(np.swapaxes(to_local, 1, 2) @ mass @ to_local),
        K_ring=_assemble(np.swapaxes(to_local, 1, 2) @ stiffness @ to_local),
        K_supports=_supports(casing, angles),
    )


def element_matrices(
    material: Material, width: float, thickness: float, lengths: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return stiffness and consistent mass (elements, 6, 6) of straight plane beams in local (u, v, phi) at both ends.

    u is along the beam, v 90 degrees counter-clockwise from it. With Phi = 12 E I / (kappa G A L^2) the static shape
    functions of a uniform Timoshenko beam interpolate v and phi, linear ones u; I = width thickness^3 / 12 (bending in
    the plane of the ring).

    - width, thickness: of the cross-section, m.
    - lengths (elements,): of the elements, m.
    """
    area, inertia = width * thickness, width * thickness**3 / 12
    E, rho = material.youngs_modulus_pa, material.density_kg_per_m3
    shear = cowper_shear_coefficient(material.poisson_ratio) * material.shear_modulus_pa * area
    points, weights = leggauss(GAUSS_POINTS)
    s = (points[None, :] + 1) / 2
    weight = (weights / 2 * lengths[:, None])[..., None, None]
    phi = (12 * E * inertia / (shear * lengths**2))[:, None]
    field, strain = _shape_functions(s, lengths[:, None], phi)
    stiffness = np.sum(weight * (np.swapaxes(strain, 2, 3) @ np.diag([E * area, shear, E * inertia]) @ strain), axis=1)
    mass = np.sum(weight * (np.swapaxes(field, 2, 3) @ np.diag(rho * np.array([area, area, inertia])) @ field), axis=1)
    return stiffness, mass


def _shape_functions(s: FloatArray, length: FloatArray, phi: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return (u, v, phi) and (u', v' - phi, phi') at s = x / L, each (element, point, 3, 6)."""
    field = np.zeros((*np.broadcast_shapes(s.shape, length.shape), 3, 6))
    strain = np.zeros_like(field)
    n = 1 / (1 + phi)
    field[..., 0, 0], field[..., 0, 3] = 1 - s, s
    field[..., 1, 1] = n * (2 * s**3 - 3 * s**2 - phi * s + 1 + phi)
    field[..., 1, 2] = n * length * (s**3 - (2 + phi / 2) * s**2 + (1 + phi / 2) * s)
    field[..., 1, 4] = n * (-2 * s**3 + 3 * s**2 + phi * s)
    field[..., 1, 5] = n * length * (s**3 - (1 - phi / 2) * s**2 - phi / 2 * s)
    field[..., 2, 1] = n * 6 / length * (s**2 - s)
    field[..., 2, 2] = n * (3 * s**2 - (4 + phi) * s + 1 + phi)
    field[..., 2, 4] = -field[..., 2, 1]
    field[..., 2, 5] = n * (3 * s**2 - (2 - phi) * s)
    strain[..., 0, 0], strain[..., 0, 3] = -1 / length, 1 / length
    strain[..., 1, 1], strain[..., 1, 4] = -n * phi / length, n * phi / length
    strain[..., 1, 2] = strain[..., 1, 5] = -n * phi / 2
    strain[..., 2, 1] = n * 6 / length**2 * (2 * s - 1)
    strain[..., 2, 2] = n / length * (6 * s - 4 - phi)
    strain[..., 2, 4] = -strain[..., 2, 1]
    strain[..., 2, 5] = n / length * (6 * s - 2 + phi)
    return field, strain


def _rotation(tangents: FloatArray) -> FloatArray:
    """Return the rotation from global to element axes, (elements, 6, 6)."""
    c, s = tangents.T
    turn = np.zeros((len(tangents), 6, 6))
    for o in (0, 3):
        turn[:, o, o] = turn[:, o + 1, o + 1] = c
        turn[:, o, o + 1], turn[:, o + 1, o] = s, -s
        turn[:, o + 2, o + 2] = 1.0
    return turn


def _assemble(blocks: FloatArray) -> SparseMatrix:
    """Sum the elements of a closed ring: element e joins nodes e and e + 1, the last one closes it."""
    n = len(blocks)
    ends = np.column_stack([np.arange(n), (np.arange(n) + 1) % n])
    dofs = (3 * ends[:, :, None] + np.arange(3)).reshape(n, 6)
    return _csr(blocks, np.repeat(dofs, 6, axis=1), np.tile(dofs, 6), 3 * n)


def _supports(casing: Casing, angles: FloatArray) -> SparseMatrix:
    e_r = np.column_stack([np.cos(angles), np.sin(angles)])
    e_t = np.column_stack([-np.sin(angles), np.cos(angles)])
    blocks = casing.radial_support_stiffness_n_per_m * e_r[:, :, None] * e_r[:, None, :]
    blocks += casing.circumferential_support_stiffness_n_per_m * e_t[:, :, None] * e_t[:, None, :]
    dofs = 3 * np.arange(casing.nodes)[:, None] + np.arange(2)
    return _csr(blocks, np.repeat(dofs, 2, axis=1), np.tile(dofs, 2), 3 * casing.nodes)


def _csr(values: FloatArray, rows: Any, columns: Any, n: int) -> SparseMatrix:
    matrix = sp.csr_array((values.ravel(), (rows.ravel(), columns.ravel())), shape=(n, n))
    return sp.csr_array((matrix + matrix.T) / 2)
