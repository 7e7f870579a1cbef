"""Craig-Bampton reduction against the unreduced matrices.

A coarse machine (three blades, disk of 1 x 6 elements) is small enough for dense solutions of the full model. There
the tolerance allows only rounding against the penalty of the couplings. Rows about bounds count the broken bounds,
with a slack of 1e-9 for rounding. The steady growth of the preset at 15,000 rev/min is compared with a direct
solution of its 14,478 equations.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.linalg import eigh, solve
from scipy.sparse.linalg import splu

from rubgen.arrays import FloatArray
from rubgen.fem.blisk import BliskModel, assemble_blisk
from rubgen.fem.constraints import factorize, on_springs, support_stiffness
from rubgen.machine import Machine, load_machine
from rubgen.reduction import reduce
from rubgen.reduction.blisk import ReducedBlisk, reduce_blisk
from rubgen.scenario import Reduction
from rubgen.units import rad_per_s
from validation.verification.row import Row, within

TITLE = "Craig-Bampton reduction"
# Interior DoFs with mass: blade 6; disk 162 less 27 drilling ones; second step all that is left.
ALL_MODES = Reduction(blade_modes=6, disk_modes=135, blisk_modes=193)
FEW_MODES = Reduction(blade_modes=1, disk_modes=1, blisk_modes=1)
COMPARED = 150
SLACK = 1e-9
SPEED, FREQUENCY = 800.0, 2000.0
TOP_SPEED_RPM = 15000.0


def coarse_machine() -> Machine:
    """The preset with three blades on a coarse mesh."""
    preset = load_machine("zeng2019")
    disk = replace(preset.disk, radial_elements=1, circumferential_elements=6)
    return replace(preset, disk=disk, blades=replace(preset.blades, count=3, elements=2))


def reduced_blisk(machine: Machine, reduction: Reduction) -> ReducedBlisk:
    """The blisk of a machine, reduced anew."""
    return reduce_blisk(machine.disk, machine.blades, machine.disk_support, reduction)


def reduced_stiffness(blisk: ReducedBlisk, springs: FloatArray) -> FloatArray:
    """Stiffness at rest with the springs at O_d."""
    K: FloatArray = blisk.K + blisk.centre.T @ (springs[:, None] * blisk.centre)
    return K


def squares(M: FloatArray, K: FloatArray) -> FloatArray:
    """Eigenvalues omega^2 ascending, of DoFs that carry mass; M may be singular."""
    compliance: FloatArray = eigh(M, K, eigvals_only=True)[::-1]
    massive: FloatArray = compliance[compliance > 1e-13 * compliance[0]]
    return 1 / massive


def static_error(full: BliskModel, springs: FloatArray, reduced: ReducedBlisk) -> float:
    """Largest error of tips and O_d, over the largest displacement, under a force at a tip and one at O_d."""
    load = np.zeros(full.M.shape[0])
    load[full.tips[2, 2]], load[0] = 1.0, -5.0
    exact = factorize(on_springs(full.K, springs)).solve(load)
    K = reduced_stiffness(reduced, springs)
    q = solve(K, np.eye(len(K))[8] - 5 * np.eye(len(K))[9])
    errors = np.concatenate([q[:9] - exact[full.tips[:, :3]].ravel(), reduced.centre @ q - exact[:6]])
    return float(np.abs(errors).max() / np.abs(exact).max())


def receptance_error(full: BliskModel, springs: FloatArray, reduced: ReducedBlisk) -> float:
    """Largest relative error of (K - w^2 M + 2 i w Omega G + Omega^2 A)^-1 from one tip to all tips."""
    A = full.K_sigma - full.S
    dynamic = on_springs(full.K, springs) - FREQUENCY**2 * full.M + SPEED**2 * A
    load = np.zeros(full.M.shape[0], dtype=np.complex128)
    load[full.tips[1, 1]] = 1.0
    exact = splu((dynamic + 2j * FREQUENCY * SPEED * full.G).tocsc()).solve(load)[full.tips[:, :3]].ravel()
    K = reduced_stiffness(reduced, springs) + SPEED**2 * reduced.A - FREQUENCY**2 * reduced.M
    found = solve(K + 2j * FREQUENCY * SPEED * reduced.G, np.eye(len(K))[4])[:9]
    return float(np.abs(found - exact).max() / np.abs(exact).max())


def growth_error(machine: Machine) -> float:
    """Largest error of the tips' steady growth at 15,000 rev/min, over the largest, against a direct solve."""
    full, speed = assemble_blisk(machine.disk, machine.blades, machine.disk_support), rad_per_s(TOP_SPEED_RPM)
    K = on_springs(full.K, support_stiffness(machine.disk_support)) + speed**2 * (full.K_sigma - full.S)
    exact = factorize(K.tocsr()).solve(speed**2 * full.f_c)[full.tips[:, :3]]
    found = reduce(machine, Reduction(blisk_modes=2)).at_speed(speed).tip_static
    return float(np.abs(found - exact).max() / np.abs(exact).max())


def rows() -> Iterator[Row]:
    """Statics, bounds, monotony, all modes kept, growth."""
    machine = coarse_machine()
    springs, source = support_stiffness(machine.disk_support), "full model, dense"
    full = assemble_blisk(machine.disk, machine.blades, machine.disk_support)
    exact = squares(full.M.toarray(), on_springs(full.K, springs).toarray())
    few = reduced_blisk(machine, FEW_MODES)
    quantity = "Craig-Bampton: static response to forces on masters, relative error"
    yield within(quantity, "full model, sparse solve", 0.0, static_error(full, springs, few), 1e-8)
    found = [
        squares(blisk.M, reduced_stiffness(blisk, springs))
        for blisk in (reduced_blisk(machine, Reduction(blisk_modes=n)) for n in (1, 2, 4, 8, 16))
    ]
    below = sum(int(np.count_nonzero(f < exact[: len(f)] * (1 - SLACK))) for f in found)
    yield within("Craig-Bampton: frequencies below the full model's", "upper bounds (Rayleigh)", 0, below, 0)
    rising = sum(int(np.count_nonzero(b[: len(a)] > a * (1 + SLACK))) for a, b in pairwise(found))
    yield within("Craig-Bampton: frequencies that rise with more modes", "Courant's minimax", 0, rising, 0)
    every = reduced_blisk(machine, ALL_MODES)
    all_squares = squares(every.M, reduced_stiffness(every, springs))
    yield within("Craig-Bampton, all modes: DoFs", "DoFs with mass, counted", len(exact), len(every.M), 0)
    error = float(np.abs(all_squares[:COMPARED] / exact[:COMPARED] - 1).max())
    yield within(f"Craig-Bampton, all modes: relative error of {COMPARED} omega^2", source, 0.0, error, 1e-8)
    quantity = "Craig-Bampton, all modes: receptance of turning tips, relative error"
    yield within(quantity, "full model, sparse solve", 0.0, receptance_error(full, springs, every), 1e-6)
    quantity = "steady growth of the preset's tips at 15,000 rev/min, relative error"
    yield within(quantity, "full model, sparse solve", 0.0, growth_error(load_machine("zeng2019")), 1e-9)
