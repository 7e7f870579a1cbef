"""Assemble the full finite-element blisk in the turning frame: disk centre, disk, blades and their couplings.

O_d is the disk centre.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rubgen.arrays import FloatArray, IntArray, SparseMatrix
from rubgen.errors import UserError
from rubgen.fem.beam import BeamMatrices, blade_matrices
from rubgen.fem.constraints import (
    FixedCentreStiffness,
    blade_rotation,
    link_stress_stiffness,
    rigid_link,
    rim_joint,
)
from rubgen.fem.disk import DiskModel, assemble_disk
from rubgen.fem.shell import shell_stress_stiffness
from rubgen.machine import BladeRow, Disk, DiskSupport
from rubgen.machine.mesh import pitch_problem

CENTRE = np.arange(6)


@dataclass(frozen=True, kw_only=True)
class BliskModel:
    """The full finite-element model of the blisk in the turning frame, without supports.

    M q'' + 2 Omega G q' + (K + Omega^2 (K_sigma - S)) q = Omega^2 f_c + loads. M is mass, G Coriolis (skew), K elastic
    stiffness, S spin softening, K_sigma stiffness from centrifugal stress at 1 rad/s; matrices are (n, n). DoFs, six a
    node: O_d, the disk's nodes in o-xyz, then each blade's nodes from root to tip along the blade's own axes.
    """

    M: SparseMatrix
    G: SparseMatrix
    K: SparseMatrix
    K_apart: SparseMatrix
    """K before the blades are joined to the rim."""
    S: SparseMatrix
    K_sigma: SparseMatrix
    f_c: FloatArray
    """Centrifugal load at 1 rad/s (n,)."""
    disk_size: int
    """Number of DoFs of O_d and the disk."""
    count: int
    """Number of blades of the whole blisk."""
    present: IntArray
    """Numbers of the blades that are there (blades,)."""
    rim: IntArray
    """DoFs of the rim node of each blade that is there (blades, 6)."""
    roots: IntArray
    """DoFs of its root (blades, 6)."""
    tips: IntArray
    """DoFs of its tip (blades, 6)."""
    angles: FloatArray
    """Its polar angle (blades,), rad."""
    blade_radius: FloatArray
    """Radii of a blade's nodes, m."""
    penalty: float
    """Penalty stiffness k_p."""
    fixed_centre: FixedCentreStiffness
    """Solves static problems of the blisk with O_d fixed laterally."""
    plate: DiskModel
    """Matrices of the disk."""
    beam: BeamMatrices
    """Matrices of one blade without mistuning."""
    blade_stiffness: FloatArray
    """Its stiffness over the stiffness of `beam` (blades,)."""


def assemble_blisk(disk: Disk, blades: BladeRow, support: DiskSupport, missing: Sequence[int] = ()) -> BliskModel:
    """Assemble the full model of the blisk, 14,478 DoFs in the preset.

    - disk, blades, support: parts of the machine. The supports only affect the centrifugal stress.
    - missing: numbers of missing blades. They have no DoFs, no mass, no stiffness and no pull on the rim.

    In the steady state at 1 rad/s the blades pull at the rim and the rigid link fixes the bore. This state determines
    the disk's plane stress, the forces in the link and the link's geometric term. K_sigma - S on rigid-body motions is
    then -m, -m, 0, I_p - I_d, I_p - I_d, 0: tests/fem/test_blisk_assembly.py. A mistuned blade differs only by (1 +
    deviation) K: E scales every term of K, the shape functions depend only on ratios of stiffness, and its pull on the
    rim follows from its mass.

    Raises UserError where blades do not meet corner nodes of the rim, and for a single blade, whose pull is not a
    symmetric load.
    """
    problem = pitch_problem(disk, blades)
    if problem:
        raise UserError(problem)
    pitch = disk.circumferential_elements // blades.count
    plate, beam = assemble_disk(disk), blade_matrices(blades, disk.rim_radius_m)
    disk_size, n_blade = 6 + plate.M.shape[0], len(beam.f_c)
    present = np.setdiff1d(np.arange(blades.count), missing)
    size = disk_size + present.size * n_blade
    roots = _dof(disk_size // 6 + n_blade // 6 * np.arange(present.size))
    bore, rim, tips = _dof(1 + plate.bore), _dof(1 + plate.rim[::pitch][present]), roots + n_blade - 6
    angles = 2 * np.pi * present / blades.count
    equal, stiffness = np.ones(present.size), 1 + np.array(blades.stiffness_deviations)[present]

    penalty = float(plate.K.diagonal().max())
    arm = plate.mesh.nodes[plate.bore]
    link, joint = rigid_link(arm, bore, CENTRE, size), rim_joint(angles, rim, roots, size)
    K_apart = sp.csr_array(_blocks(plate.K, beam.K, stiffness) + penalty * (link.T @ link))
    K = sp.csr_array(K_apart + penalty * (joint.T @ joint))
    f_c = np.concatenate([np.zeros(6), plate.f_c, *[beam.f_c] * present.size])
    fixed_centre = FixedCentreStiffness(K, support)
    static = fixed_centre.solve(f_c)
    K_plate = shell_stress_stiffness(plate.mesh, disk.material, static[6:disk_size])
    link_force = -penalty * (link @ static).reshape(-1, 6)[:, :3]
    return BliskModel(
        M=_blocks(plate.M, beam.M, equal),
        G=_blocks(plate.G, beam.G, equal),
        K=K,
        K_apart=K_apart,
        S=_blocks(plate.S, beam.S, equal),
        K_sigma=_blocks(K_plate, beam.K_sigma, equal, link_stress_stiffness(arm, link_force)),
        f_c=f_c,
        disk_size=disk_size,
        count=blades.count,
        present=present,
        rim=rim,
        roots=roots,
        tips=tips,
        angles=angles,
        blade_radius=disk.rim_radius_m + np.linspace(0.0, blades.length_m, blades.elements + 1),
        penalty=penalty,
        fixed_centre=fixed_centre,
        plate=plate,
        beam=beam,
        blade_stiffness=stiffness,
    )


def rigid_motions(model: BliskModel) -> FloatArray:
    """Return displacements (n, 6) of the blisk moved as a rigid body by unit u, v, w (m), th_x, th_y, th_z (rad)."""
    plate = model.plate.mesh.nodes
    x, y = np.concatenate([[0.0], plate[:, 0]]), np.concatenate([[0.0], plate[:, 1]])
    return np.concatenate([_rigid_nodes(x, y), *[blade_motions(model, angle) for angle in model.angles]])


def blade_motions(model: BliskModel, angle: float) -> FloatArray:
    """Return the displacements (DoFs of a blade, 6) of a blade in the motions of `rigid_motions`.

    The displacements are along the blade's own axes, the motions along o-xyz. `angle` is the polar angle of the blade,
    rad.
    """
    radius = model.blade_radius
    in_disk_axes = _rigid_nodes(radius * np.cos(angle), radius * np.sin(angle)).reshape(-1, 6, 6)
    return np.asarray((blade_rotation(angle).T @ in_disk_axes).reshape(-1, 6))


def _rigid_nodes(x: FloatArray, y: FloatArray) -> FloatArray:
    R = np.zeros((len(x), 6, 6))
    R[:] = np.eye(6)
    R[:, 0, 5], R[:, 1, 5] = -y, x
    R[:, 2, 3], R[:, 2, 4] = y, -x
    return R.reshape(-1, 6)


def _dof(nodes: IntArray) -> IntArray:
    return 6 * nodes[:, None] + np.arange(6)


def _blocks(
    plate: SparseMatrix, blade: FloatArray, scale: FloatArray, centre: FloatArray | None = None
) -> SparseMatrix:
    """Return diag(O_d, disk, scale_0 blade, scale_1 blade, ...). O_d has only the matrix of the link."""
    first = np.zeros((6, 6)) if centre is None else centre
    one = sp.coo_array(blade)
    blocks = [sp.coo_array(first), plate, *[factor * one for factor in scale]]
    return sp.csr_array(sp.block_diag(blocks, format="csr"))
