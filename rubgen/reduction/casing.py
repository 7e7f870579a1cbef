"""Reduce the casing to its first modes."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np
from scipy.linalg import eigh

from rubgen.arrays import FloatArray
from rubgen.errors import UserError
from rubgen.fem.casing import CasingModel, assemble_casing
from rubgen.machine.faults.fault import SurfaceHarmonic
from rubgen.machine.machine import Casing, Machine
from rubgen.reduction.model import CasingSurface
from rubgen.scenario.checks.reducible import casing_problem

# Pairs closer than this in omega^2 are one pair to the eigen-solver's precision: their orientation is chosen here.
DEGENERATE = 1e-8


@dataclass(frozen=True, kw_only=True)
class ReducedCasing:
    """The first modes of the casing on its springs."""

    frequencies_hz: FloatArray
    """Frequencies (n,) in Hz, ascending."""
    modes_xy: FloatArray
    """X and Y displacement of the mass-normalised modes (nodes, 2, n), kg^-1/2; nodes at equal steps of polar angle
    from 0."""
    rotations: FloatArray
    """Rotation of the cross-section about Z (nodes, n), m^-1 kg^-1/2."""
    surface: CasingSurface
    """The undeformed inner surface."""


def reduce_casing(machine: Machine, modes: int) -> ReducedCasing:
    """Compute the first `modes` modes of the casing, mass-normalised, and its undeformed inner surface.

    The harmonics of the surface that faults of the machine cause are added. Solves K phi = omega^2 M phi. Signs are
    fixed: radial plus tangential displacement is positive at the node nearest to the lobe axis, where a symmetric mode
    is radial and an antisymmetric mode tangential. Of two modes of the same frequency the second has no radial
    displacement there.

    Raises UserError for less than one mode, for more modes than DoFs, for modes that do not include the order of the
    casing's lobes in full (`carried_orders`), and for a mesh that `assemble_casing` refuses.
    """
    problem = casing_problem(machine, modes)
    if problem:
        raise UserError(problem)
    asked = _Asked(casing=machine.casing, mean_radius=machine.casing_mean_radius_m, modes=modes, machine=machine)
    return with_harmonics(
        _reduced(asked), [each for fault in machine.faults for each in fault.surface_harmonics(machine)]
    )


def with_harmonics(casing: ReducedCasing, harmonics: Sequence[SurfaceHarmonic]) -> ReducedCasing:
    """Return the casing with further harmonics of its inner surface. The modes are not changed."""
    surface = casing.surface
    added = CasingSurface(
        mean_radius=surface.mean_radius,
        amplitude=np.append(surface.amplitude, [each.amplitude_m for each in harmonics]),
        order=np.append(surface.order, [float(each.order) for each in harmonics]),
        phase=np.append(surface.phase, [each.phase_rad for each in harmonics]),
    )
    return replace(casing, surface=added) if harmonics else casing


@dataclass(frozen=True, kw_only=True)
class _Asked:
    """All inputs of a casing's modes: runs that vary other values share them."""

    casing: Casing
    mean_radius: float
    modes: int
    machine: Machine = field(compare=False)


@lru_cache(maxsize=4)
def _reduced(asked: _Asked) -> ReducedCasing:
    machine, modes = asked.machine, asked.modes
    model = assemble_casing(machine)
    eigenvalues, vectors = _lowest_modes(model, modes)
    fields = vectors.reshape(-1, 3, modes)
    lobe_angle = np.deg2rad(machine.casing.lobe_angle_deg)
    modes_xy, rotations = _oriented(fields[:, :2], fields[:, 2], eigenvalues, model.angles, float(lobe_angle))
    return ReducedCasing(
        frequencies_hz=np.sqrt(eigenvalues) / (2 * np.pi),
        modes_xy=modes_xy,
        rotations=rotations,
        surface=CasingSurface(
            mean_radius=machine.casing_mean_radius_m,
            amplitude=np.array([-machine.casing.ovality_m / 2]),
            order=np.array([float(machine.casing.lobes)]),
            phase=np.array([lobe_angle]),
        ),
    )


def _lowest_modes(model: CasingModel, modes: int) -> tuple[FloatArray, FloatArray]:
    # The spectrum is a cluster with pairs in it: the dense solver is sure to find every one of them, in some 30 ms for
    # 180 nodes, where a single-vector Lanczos run may miss one mode of a doublet.
    eigenvalues, vectors = eigh(model.K.toarray(), model.M.toarray(), subset_by_index=[0, modes - 1])
    return eigenvalues, vectors


def _oriented(
    displacements: FloatArray, rotations: FloatArray, eigenvalues: FloatArray, angles: FloatArray, lobe_angle: float
) -> tuple[FloatArray, FloatArray]:
    """Return the same modes, with pairs of equal frequency turned to the lobe axis and every sign fixed."""
    oriented, turned = np.array(displacements), np.array(rotations)
    node = round(lobe_angle / (angles[1] - angles[0])) % angles.size
    e_r = np.array([np.cos(angles[node]), np.sin(angles[node])])
    e_t = np.array([-e_r[1], e_r[0]])
    mode = 0
    while mode + 1 < eigenvalues.size:
        if eigenvalues[mode + 1] - eigenvalues[mode] < DEGENERATE * eigenvalues[mode]:
            pair = slice(mode, mode + 2)
            first, second = e_r @ oriented[node, :, pair]
            c, s = np.array([first, second]) / np.hypot(first, second)
            oriented[:, :, pair] = oriented[:, :, pair] @ np.array([[c, -s], [s, c]])
            turned[:, pair] = turned[:, pair] @ np.array([[c, -s], [s, c]])
            mode += 1
        mode += 1
    signs = np.where((e_r + e_t) @ oriented[node] < 0, -1.0, 1.0)
    return oriented * signs, turned * signs
