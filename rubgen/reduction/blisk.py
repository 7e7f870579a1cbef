"""Reduce the blisk by Craig-Bampton in two steps, with its basis at rest.

O_d is the disk centre.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.linalg import block_diag, eigh

from rubgen.arrays import FloatArray, IntArray
from rubgen.fem.beam import BeamMatrices, skew, symmetric
from rubgen.fem.blisk import BliskModel, assemble_blisk, blade_motions, rigid_motions
from rubgen.fem.constraints import on_springs, rim_joint, support_stiffness
from rubgen.machine import BladeRow, Disk, DiskSupport
from rubgen.reduction.craig_bampton import Turning, craig_bampton, disk_turning
from rubgen.reduction.growth import CentrifugalGrowth, centrifugal_growth
from rubgen.scenario import Reduction

DUST = 1e-9
"""Mass of a tip without a blade over the largest mass of a coordinate: matrices of masses must be regular."""


@dataclass(frozen=True, kw_only=True)
class ReducedBlisk:
    """The reduced blisk with n DoFs, without supports.

    The DoFs are the tips' translations along the blades' axes, x and y of the disk centre O_d, and modes. A missing
    blade keeps the DoFs of its tip, so that all blades keep their numbers. These DoFs have a negligible mass, are not
    coupled, and no load acts on them.
    """

    M: FloatArray
    """Mass (n, n)."""
    K: FloatArray
    """Elastic stiffness (n, n)."""
    G: FloatArray
    """Coriolis matrix (n, n), skew."""
    A: FloatArray
    """K_sigma - S at 1 rad/s (n, n)."""
    euler: FloatArray
    """f_t (n,): M times the rotation by 1 rad, the load of an angular acceleration of -1 rad/s2."""
    centre: FloatArray
    """T (6, n): all six DoFs of O_d."""
    roots: FloatArray
    """All six DoFs of each blade's root along its axes (blades, 6, n)."""
    growth: CentrifugalGrowth
    """The tips' steady centrifugal displacement."""
    rigid_inertia: FloatArray
    """m, m, m, I_d, I_d, I_p of the whole (6,), kg, kg m2, with the blades that are missing."""
    blade_frequency: float
    """First frequency of a blade clamped at its root, without mistuning, rad/s."""
    full_size: int
    """Number of DoFs of the full model."""


@dataclass(frozen=True, kw_only=True)
class _Joined:
    """Blisk after the first step: matrices (n, n), O_d first.

    `tips` and `roots` (blades, 6) are DoFs, `euler` f_t (n,).
    """

    M: FloatArray
    K: FloatArray
    G: FloatArray
    A: FloatArray
    tips: IntArray
    roots: IntArray
    euler: FloatArray


def reduce_blisk(
    disk: Disk,
    blades: BladeRow,
    support: DiskSupport,
    reduction: Reduction,
    missing: Sequence[int] = (),
    *,
    cyclic: bool = True,
) -> ReducedBlisk:
    """Reduce the blisk to its tips, O_d x and y, and modes. The matrices of the result are without springs.

    Step 1: each blade keeps root, tip and `blade_modes` fixed-interface modes. The disk keeps O_d, the rim nodes with
    blades and `disk_modes`. Penalties join blades and rim. Step 2, on the axial, tilt and torsion springs: the tips'
    translations and O_d x, y remain, with `blisk_modes`. Coriolis and centrifugal matrices are projected on this basis
    at rest, which is more accurate than a basis of the spinning blisk. A number of disk modes that splits a pair of
    equal frequencies, as 4 does in the preset, changes frequency pairs by up to 1e-5. The lateral stiffness has no
    influence: it acts on masters.

    - disk, blades, support: parts of the machine.
    - reduction: numbers of modes.
    - missing: numbers of the blades that are missing. Their tips keep uncoupled DoFs (`with_places`).
    - cyclic: use one sector of the disk for all sectors. False uses the sparse matrices of the whole disk, in twice the
      time and with the same result to 1e-9. A disk with missing blades is never cyclic.

    Raises UserError as `assemble_blisk` and `craig_bampton` do.
    """
    model = assemble_blisk(disk, blades, support, missing)
    joined = _join_components(model, reduction, _turning(disk, blades) if cyclic and not missing else None)
    masters = np.concatenate([joined.tips[:, :3].ravel(), [0, 1]])
    supported = on_springs(sp.csr_array(joined.K), support_stiffness(support))
    V = craig_bampton(sp.csr_array(joined.M), supported, masters, reduction.blisk_modes)
    reduced = ReducedBlisk(
        M=symmetric(V.T @ joined.M @ V),
        K=symmetric(V.T @ joined.K @ V),
        G=skew(V.T @ joined.G @ V),
        A=symmetric(V.T @ joined.A @ V),
        euler=V.T @ joined.euler,
        centre=np.ascontiguousarray(V[:6]),
        roots=np.ascontiguousarray(V[joined.roots]),
        growth=centrifugal_growth(model),
        rigid_inertia=_rigid_inertia(model),
        blade_frequency=_clamped_frequency(model.beam),
        full_size=model.M.shape[0],
    )
    return with_places(reduced, model.present, model.count) if missing else reduced


def with_places(blisk: ReducedBlisk, present: IntArray, count: int) -> ReducedBlisk:
    """Return the blisk with three DoFs for each of `count` tips; before, only the blades `present` have them.

    Each DoF of a tip without a blade is uncoupled. It has the mass DUST times the largest mass of a DoF, and the
    highest frequency of the blisk. The root of a missing blade has zeros.
    """
    size = len(blisk.M) + 3 * (count - present.size)
    own = np.concatenate([(3 * present[:, None] + np.arange(3)).ravel(), np.arange(3 * count, size)])
    lost = np.setdiff1d(np.arange(size), own)
    highest = float(eigh(blisk.K, blisk.M, eigvals_only=True)[-1])
    mass = DUST * float(blisk.M.diagonal().max())

    def placed(matrix: FloatArray, diagonal: float = 0.0) -> FloatArray:
        whole = np.zeros((size, size))
        whole[np.ix_(own, own)] = matrix
        whole[lost, lost] = diagonal
        return whole

    euler, centre, roots = np.zeros(size), np.zeros((6, size)), np.zeros((count, 6, size))
    euler[own], centre[:, own] = blisk.euler, blisk.centre
    roots[np.ix_(present, np.arange(6), own)] = blisk.roots
    return replace(
        blisk,
        M=placed(blisk.M, mass),
        K=placed(blisk.K, mass * highest),
        G=placed(blisk.G),
        A=placed(blisk.A),
        euler=euler,
        centre=centre,
        roots=roots,
    )


def _rigid_inertia(model: BliskModel) -> FloatArray:
    """Return the inertia (6,) of the blisk with all of its blades: its dampers were made for it."""
    R = rigid_motions(model)
    inertia = np.einsum("ij,ij->j", R, model.M @ R)
    for number in np.setdiff1d(np.arange(model.count), model.present):
        motions = blade_motions(model, 2 * np.pi * number / model.count)
        inertia += np.einsum("ij,ij->j", motions, model.beam.M @ motions)
    return np.asarray(inertia)


def _turning(disk: Disk, blades: BladeRow) -> Turning:
    """Return the disk's turns: rings of corner nodes have two nodes an element, rings between them one."""
    rings = np.arange(2 * disk.radial_elements + 1)
    return disk_turning(np.where(rings % 2, 1, 2) * disk.circumferential_elements, blades.count)


def _join_components(model: BliskModel, reduction: Reduction, turning: Turning | None) -> _Joined:
    """Take the first step: disk [O_d, rim nodes, modes], then blades [root, tip, modes], joined at the rim."""
    count, n_blade = len(model.angles), len(model.beam.f_c)
    plate, blade = slice(0, model.disk_size), slice(model.disk_size, model.disk_size + n_blade)
    ends = np.concatenate([np.arange(6), np.arange(n_blade - 6, n_blade)])
    kept = np.concatenate([np.arange(6), model.rim.ravel()])
    K_blade = sp.csr_array(model.beam.K)
    V_plate = craig_bampton(model.M[plate, plate], model.K_apart[plate, plate], kept, reduction.disk_modes, turning)
    # Blades that differ by a factor of K alone have one basis: statics and shapes of modes do not know the factor.
    V_blade = craig_bampton(model.M[blade, blade], K_blade, ends, reduction.blade_modes)

    def project(X: sp.csr_array, one_blade: sp.csr_array, scale: FloatArray, *, skew: bool = False) -> FloatArray:
        of_plate = X[plate, plate]
        on_plate = turning.project(of_plate, V_plate, skew=skew) if turning else V_plate.T @ (of_plate @ V_plate)
        on_blade = V_blade.T @ (one_blade @ V_blade)
        return np.asarray(block_diag(on_plate, *[factor * on_blade for factor in scale]))

    def of_equal_blades(X: sp.csr_array, *, skew: bool = False) -> FloatArray:
        return project(X, X[blade, blade], np.ones(count), skew=skew)

    K = project(model.K_apart, K_blade, model.blade_stiffness)
    six = np.arange(6)
    rim = 6 + 6 * np.arange(count)[:, None] + six
    roots = V_plate.shape[1] + V_blade.shape[1] * np.arange(count)[:, None] + six
    joint = rim_joint(model.angles, rim, roots, len(K))
    load = model.M @ rigid_motions(model)[:, 5]
    on_blades = load[model.disk_size :].reshape(count, n_blade) @ V_blade
    return _Joined(
        M=of_equal_blades(model.M),
        K=K + model.penalty * (joint.T @ joint).toarray(),
        G=of_equal_blades(model.G, skew=True),
        A=of_equal_blades(sp.csr_array(model.K_sigma - model.S)),
        tips=roots + 6,
        roots=roots,
        euler=np.concatenate([V_plate.T @ load[plate], on_blades.ravel()]),
    )


def _clamped_frequency(beam: BeamMatrices) -> float:
    squares: FloatArray = eigh(beam.K[6:, 6:], beam.M[6:, 6:], eigvals_only=True)
    return float(np.sqrt(squares[0]))
