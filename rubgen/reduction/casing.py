"""The casing's reduction: its first modes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from rubgen.arrays import FloatArray
from rubgen.errors import UserError
from rubgen.fem.casing import CasingModel, assemble_casing
from rubgen.machine.machine import Machine
from rubgen.reduction.model import CasingSurface

# Pairs closer than this in omega^2 are one pair to the eigen-solver's precision: their orientation is chosen here.
DEGENERATE = 1e-8


@dataclass(frozen=True, kw_only=True)
class ReducedCasing:
    """The first modes of the casing on its springs.

    `frequencies_hz` (n,) ascending; `modes_xy` (nodes, 2, n) the X and Y displacements of the mass-normalised modes
    (in kg^-1/2) at nodes that stand at equal steps of polar angle from 0; `surface` the undeformed inner surface.
    """

    frequencies_hz: FloatArray
    modes_xy: FloatArray
    surface: CasingSurface


def largest_casing_order(modes: int) -> int:
    """Highest circumferential order that the first `modes` modes of a ring carry in full: (modes - 1) // 2.

    A ring on springs has one mode of order 0 (it turns as a whole; breathing lies far above) and two of each order
    from 1 on.
    """
    return (modes - 1) // 2


def reduce_casing(machine: Machine, modes: int) -> ReducedCasing:
    """The first `modes` modes of the casing, mass-normalised, and its undeformed inner surface.

    Solves K phi = omega^2 M phi. Signs are fixed: radial plus tangential displacement is positive at the node nearest
    to the lobe axis, where a symmetric mode is radial and an antisymmetric one tangential. Of two modes of the same
    frequency the second has no radial displacement there.

    Raises UserError when the casing has more lobes than the modes can carry (`largest_casing_order`), or for a mesh
    that `assemble_casing` refuses.
    """
    _check_lobes(machine.casing.lobes, modes)
    model = assemble_casing(machine)
    eigenvalues, vectors = _lowest_modes(model, modes)
    displacements = vectors.reshape(-1, 3, modes)[:, :2]
    lobe_angle = np.deg2rad(machine.casing.lobe_angle_deg)
    return ReducedCasing(
        frequencies_hz=np.sqrt(eigenvalues) / (2 * np.pi),
        modes_xy=_oriented(displacements, eigenvalues, model.angles, float(lobe_angle)),
        surface=CasingSurface(
            mean_radius=machine.casing_mean_radius_m,
            amplitude=np.array([-machine.casing.ovality_m / 2]),
            order=np.array([float(machine.casing.lobes)]),
            phase=np.array([lobe_angle]),
        ),
    )


def _check_lobes(lobes: int, modes: int) -> None:
    if lobes > largest_casing_order(modes):
        raise UserError(
            f"casing.lobes = {lobes}: {modes} casing modes carry orders up to {largest_casing_order(modes)}; "
            f"take fewer lobes, or at least {2 * lobes + 1} casing modes"
        )


def _lowest_modes(model: CasingModel, modes: int) -> tuple[FloatArray, FloatArray]:
    # The spectrum is a cluster with pairs in it: the dense solver is sure to find every one of them, in some 30 ms for
    # 180 nodes, where a single-vector Lanczos run may miss a twin.
    eigenvalues, vectors = eigh(model.K.toarray(), model.M.toarray(), subset_by_index=[0, modes - 1])
    return eigenvalues, vectors


def _oriented(displacements: FloatArray, eigenvalues: FloatArray, angles: FloatArray, lobe_angle: float) -> FloatArray:
    """The same modes with pairs of equal frequency turned to the lobe axis and every sign fixed."""
    oriented = np.array(displacements)
    node = round(lobe_angle / (angles[1] - angles[0])) % angles.size
    e_r = np.array([np.cos(angles[node]), np.sin(angles[node])])
    e_t = np.array([-e_r[1], e_r[0]])
    mode = 0
    while mode + 1 < eigenvalues.size:
        if eigenvalues[mode + 1] - eigenvalues[mode] < DEGENERATE * eigenvalues[mode]:
            first, second = e_r @ oriented[node, :, mode : mode + 2]
            c, s = np.array([first, second]) / np.hypot(first, second)
            oriented[:, :, mode : mode + 2] = oriented[:, :, mode : mode + 2] @ np.array([[c, -s], [s, c]])
            mode += 1
        mode += 1
    signs = np.where((e_r + e_t) @ oriented[node] < 0, -1.0, 1.0)
    result: FloatArray = oriented * signs
    return result
