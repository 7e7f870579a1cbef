"""Assemble the disk: its mesh of eight-node shells and its matrices in the turning frame."""

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray, IntArray, SparseMatrix
from rubgen.fem.shell import shell_inertia, shell_stiffness
from rubgen.fem.shell_strains import ShellMesh
from rubgen.machine import Disk


@dataclass(frozen=True, kw_only=True)
class DiskModel:
    """The free disk as shells: its mesh, and its matrices (6 n, 6 n) in the turning frame for n nodes.

    M is mass, K elastic stiffness, G Coriolis (skew), S spin softening, f_c (6 n,) centrifugal load at 1 rad/s. The
    equations are M q'' + 2 Omega G q' + (K - Omega^2 S) q = Omega^2 f_c + loads, and the centrifugal stress is added.
    `bore` (2 c,) are the nodes at the bore, `rim` (c,) the corner nodes at the rim, counter-clockwise from +x. c is the
    number of elements around.
    """

    mesh: ShellMesh
    M: SparseMatrix
    K: SparseMatrix
    G: SparseMatrix
    S: SparseMatrix
    f_c: FloatArray
    bore: IntArray
    rim: IntArray


def assemble_disk(disk: Disk) -> DiskModel:
    """Assemble the shell model of the disk, 7 x 72 elements in the preset. M, G and S contain rotary inertia.

    f_c = int rho N^T r_perp equals S r exactly, because the element represents the field r_perp.
    """
    mesh = annular_mesh(disk)
    inertia = shell_inertia(mesh, disk.material)
    n, n_c = len(mesh.nodes), disk.circumferential_elements
    position = np.zeros((n, 6))
    position[:, :2] = mesh.nodes
    return DiskModel(
        mesh=mesh,
        M=inertia.M,
        K=shell_stiffness(mesh, disk.material),
        G=inertia.G,
        S=inertia.S,
        f_c=inertia.S @ position.ravel(),
        bore=np.arange(2 * n_c),
        rim=n - 2 * n_c + 2 * np.arange(n_c),
    )


def annular_mesh(disk: Disk) -> ShellMesh:
    """Make the mesh of the annulus, rings from the bore outwards, with all nodes on true circles.

    The nodes of a ring follow each other counter-clockwise from +x. A ring through the corners of elements has two
    nodes an element (corner and midside). A ring between two of these has one node for each element, at the angle of a
    corner.
    """
    n_r, n_c = disk.radial_elements, disk.circumferential_elements
    radii = np.linspace(disk.bore_radius_m, disk.rim_radius_m, 2 * n_r + 1)
    rings = [_ring(radius, n_c if i % 2 else 2 * n_c) for i, radius in enumerate(radii)]
    i, j = (grid.ravel() for grid in np.meshgrid(np.arange(n_r), np.arange(n_c), indexing="ij"))
    inner, middle, outer = 3 * n_c * i, 3 * n_c * i + 2 * n_c, 3 * n_c * (i + 1)
    here, half, there = 2 * j, 2 * j + 1, (2 * j + 2) % (2 * n_c)
    # xi runs outwards, eta counter-clockwise: the corners are then counter-clockwise.
    corners = [inner + here, outer + here, outer + there, inner + there]
    midsides = [middle + j, outer + half, middle + (j + 1) % n_c, inner + half]
    slope = (disk.rim_thickness_m - disk.bore_thickness_m) / (disk.rim_radius_m - disk.bore_radius_m)

    def thickness(points: FloatArray) -> FloatArray:
        radius = np.hypot(points[..., 0], points[..., 1])
        return disk.bore_thickness_m + slope * (radius - disk.bore_radius_m)

    return ShellMesh(np.concatenate(rings), np.stack(corners + midsides, axis=1), thickness, around=n_c)


def _ring(radius: float, count: int) -> FloatArray:
    angle = 2 * np.pi * np.arange(count) / count
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
