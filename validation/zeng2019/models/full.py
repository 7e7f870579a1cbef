"""The unreduced blisk and its parts: natural frequencies at rest and at speed, and its modes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import scipy.sparse as sp
from scipy.linalg import eigh
from scipy.optimize import brentq
from scipy.sparse.linalg import LinearOperator, eigs, eigsh, splu

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.fem.blisk import BliskModel, assemble_blisk
from rubgen.fem.constraints import factorize, on_springs, support_stiffness
from rubgen.machine import Machine, load_machine
from rubgen.reduction.craig_bampton import craig_bampton
from rubgen.units import rad_per_s
from validation.piece import Arrays
from validation.zeng2019.size import MACHINE

SHIFT_HZ, WANTED = 180.0, 46
"""Eigenvalues at speed are sought around this frequency: so many reach from 0 to the 42nd, where a gap follows."""
CRITICAL_BETWEEN_RPM = (8000.0, 9500.0)
SINGLE_MODES = 7
"""The paper looks at the first seven frequencies of one blade and of the disk."""


@dataclass(frozen=True, kw_only=True)
class Modes:
    """Lowest modes at rest, mass-normalised: frequencies (m,) in Hz and shapes (n, m)."""

    frequencies_hz: FloatArray
    shapes: FloatArray


@cache
def full_blisk() -> tuple[Machine, BliskModel]:
    """The preset and its full blisk."""
    machine = load_machine(MACHINE)
    return machine, assemble_blisk(machine.disk, machine.blades, machine.disk_support)


def lowest_modes(M: sp.csr_array, K: sp.csr_array, count: int) -> Modes:
    """The lowest `count` modes of K phi = omega^2 M phi by shift and invert, K positive definite."""
    inverse = LinearOperator(K.shape, matvec=factorize(K).solve, dtype=np.float64)
    start = np.sin(1.0 + np.arange(K.shape[0]))
    squares, shapes = eigsh(K, k=count, M=M, sigma=0.0, OPinv=inverse, v0=start, tol=1e-9, ncv=2 * count + 20)
    order = np.argsort(squares)
    return Modes(frequencies_hz=np.sqrt(squares[order]) / (2 * np.pi), shapes=shapes[:, order])


def blisk_modes(count: int) -> Modes:
    """The lowest modes of the full blisk on its supports."""
    machine, model = full_blisk()
    return lowest_modes(model.M, on_springs(model.K, support_stiffness(machine.disk_support)), count)


def disk_modes(count: int) -> Modes:
    """The lowest modes of the full disk alone on its supports; DoFs are O_d and the disk's nodes."""
    machine, model = full_blisk()
    part = slice(0, model.disk_size)
    K = on_springs(model.K_apart[part, part], support_stiffness(machine.disk_support))
    return lowest_modes(model.M[part, part], K, count)


def blade_frequencies(count: int) -> FloatArray:
    """The lowest frequencies of one blade clamped at its root, in Hz."""
    beam = full_blisk()[1].beam
    squares: FloatArray = eigh(beam.K[6:, 6:], beam.M[6:, 6:], eigvals_only=True)[:count]
    return np.sqrt(squares) / (2 * np.pi)


def blade_convergence(counts: list[int]) -> Arrays:
    """`full` (7,) and `reduced` (counts, 7) frequencies in Hz of one clamped blade by fixed-interface modes kept."""
    beam = full_blisk()[1].beam
    n = len(beam.f_c)
    ends = np.concatenate([np.arange(6), np.arange(n - 6, n)])
    V = craig_bampton(sp.csr_array(beam.M), sp.csr_array(beam.K), ends, max(counts))[:, 6:]
    M, K = V.T @ beam.M @ V, V.T @ beam.K @ V
    return {"full": blade_frequencies(SINGLE_MODES), "reduced": _lowest_of(M, K, 6, counts)}


def disk_convergence(counts: list[int]) -> Arrays:
    """`full` (7,) and `reduced` (counts, 7) frequencies in Hz of the disk by fixed-interface modes kept."""
    machine, model = full_blisk()
    part = slice(0, model.disk_size)
    M, K = model.M[part, part], model.K_apart[part, part]
    masters = np.concatenate([np.arange(6), model.rim.ravel()])
    V = craig_bampton(M, K, masters, max(counts))
    springs = np.pad(support_stiffness(machine.disk_support), (0, V.shape[1] - 6))
    reduced = _lowest_of(V.T @ (M @ V), V.T @ (K @ V) + np.diag(springs), len(masters), counts)
    return {"full": disk_modes(SINGLE_MODES).frequencies_hz, "reduced": reduced}


def blisk_convergence(count: int) -> Arrays:
    """`hz` (count,): frequencies of the full blisk at rest."""
    return {"hz": blisk_modes(count).frequencies_hz}


def spinning_frequencies(speed_rpm: float, count: int) -> Arrays:
    """`hz` (count,): the lowest frequencies of the full blisk in the turning frame at that speed, undamped.

    Shift and invert of M q'' + 2 Omega G q' + (K + Omega^2 (K_sigma - S)) q = 0 about i 2 pi SHIFT_HZ, in first-order
    form. Raises ValueError where those found do not reach down to 0.
    """
    if speed_rpm == 0:
        return {"hz": blisk_modes(count).frequencies_hz}
    machine, model = full_blisk()
    omega = rad_per_s(speed_rpm)
    A = model.K_sigma - model.S
    K = on_springs(model.K, support_stiffness(machine.disk_support)) + omega**2 * A
    shift = 2j * np.pi * SHIFT_HZ
    values = _around(model.M, 2 * omega * model.G, K, shift)
    if np.abs(values - shift).max() < abs(shift):
        raise ValueError(f"{WANTED} eigenvalues around {SHIFT_HZ:g} Hz do not reach down to 0 Hz")
    found = np.sort(values.imag[values.imag > 0]) / (2 * np.pi)
    return {"hz": found[:count]}


def critical_speed() -> Arrays:
    """`rpm`: speed at which the full blisk's forward lateral whirl is synchronous with the rotation, undamped.

    An unbalance stands still in the turning frame: there the stiffness that it meets, the inverse of
    e_x^T (K + Omega^2 (K_sigma - S))^-1 e_x at O_d, passes through zero.
    """
    machine, model = full_blisk()
    K = on_springs(model.K, support_stiffness(machine.disk_support))
    A = model.K_sigma - model.S
    load = np.zeros(K.shape[0])
    load[0] = 1.0

    def met(rpm: float) -> float:
        return float(1 / factorize(K + rad_per_s(rpm) ** 2 * A).solve(load)[0])

    return {"rpm": np.array(brentq(met, *CRITICAL_BETWEEN_RPM, xtol=0.01))}


def _around(M: sp.csr_array, C: sp.csr_array, K: sp.csr_array, shift: complex) -> ComplexArray:
    """The eigenvalues s of s^2 M + s C + K nearest to the shift."""
    n = M.shape[0]
    factor = splu(sp.csc_array(shift**2 * M + shift * C + K), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.01)
    right = C + shift * M

    def apply(x: ComplexArray) -> ComplexArray:
        # (A - shift B)^-1 B of A = [[0, I], [-K, -C]], B = diag(I, M).
        first = -factor.solve(M @ x[n:] + right @ x[:n])
        return np.concatenate([first, x[:n] + shift * first])

    operator = LinearOperator((2 * n, 2 * n), matvec=apply, dtype=np.complex128)
    start = np.sin(1.0 + np.arange(2 * n)).astype(np.complex128)
    inverses = eigs(operator, k=WANTED, v0=start, tol=1e-7, return_eigenvectors=False)
    return np.asarray(shift + 1 / inverses, dtype=np.complex128)


def _lowest_of(M: FloatArray, K: FloatArray, masters: int, counts: list[int]) -> FloatArray:
    """The first seven frequencies (counts, 7) in Hz with the first `masters + count` coordinates of M and K."""
    kept = [slice(masters + count) for count in counts]
    compliance = [eigh(M[part, part], K[part, part], eigvals_only=True)[::-1][:SINGLE_MODES] for part in kept]
    return np.asarray(1 / np.sqrt(compliance) / (2 * np.pi), dtype=np.float64)
