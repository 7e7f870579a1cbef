"""The reduced blisk: frequencies at rest, and the Campbell diagram with directions of whirl."""

from __future__ import annotations

import numpy as np
from scipy.linalg import block_diag, eig

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.machine import load_machine
from rubgen.reduction import ReducedModel, reduce
from rubgen.scenario import Reduction
from rubgen.units import rad_per_s
from validation.piece import Arrays
from validation.zeng2019.size import MACHINE

PURE = 0.98
"""A mode belongs to a nodal diameter that holds this share of its tips' amplitude squared."""
SHOWN = 12
"""Lowest forward and backward frequencies of one nodal diameter that are kept at each speed."""


def model_of(blisk_modes: int, blade_modes: int = 4) -> ReducedModel:
    """The preset with so many modes of the blisk and of each blade."""
    return reduce(load_machine(MACHINE), Reduction(blisk_modes=blisk_modes, blade_modes=blade_modes))


def reduced_frequencies(blisk_modes: int, blade_modes: int = 4) -> Arrays:
    """`hz` at rest of the blisk, `casing_hz`, `dof`, `full_dof`, `critical_speed_rpm`."""
    model = model_of(blisk_modes, blade_modes)
    return {
        "hz": model.blisk_frequencies_hz(),
        "casing_hz": model.casing_frequencies_hz,
        "dof": np.array(model.reduced_dof),
        "full_dof": np.array(model.full_dof),
        "critical_speed_rpm": np.array(model.critical_speed_rpm),
    }


def campbell(blisk_modes: int, top_rpm: float, step_rpm: int) -> Arrays:
    """Frequencies at `rpm` (s,): `lowest` (s, 42) of the turning frame; `forward`, `backward` (s, 12) in Hz.

    The latter two are those of one nodal diameter (and of none, once in each) seen from the inertial frame, where the
    unbalance turns at f_r: a wave of one nodal diameter that travels at omega in the turning frame is seen at
    omega + Omega.
    """
    model = model_of(blisk_modes)
    rpm = np.arange(0.0, top_rpm + 1, step_rpm)
    rows = [_at_speed(model, speed) for speed in rpm]
    return {"rpm": rpm} | {name: np.array([row[name] for row in rows]) for name in rows[0]}


def _at_speed(model: ReducedModel, rpm: float) -> Arrays:
    speed = rad_per_s(max(rpm, 1.0))  # at rest pairs are mixed at will
    values, vectors = whirl(model.blisk.M, 2 * speed * model.blisk.G, model.stiffness(speed))
    seen = seen_frequencies(values, vectors, model.machine.blades.count, speed) / (2 * np.pi)
    lowest = np.sort(values[values > 0])[:42] / (2 * np.pi)
    return {"lowest": lowest, "forward": _first(seen[seen > 0]), "backward": _first(-seen[seen < 0])}


def whirl(M: FloatArray, C: FloatArray, K: FloatArray) -> tuple[FloatArray, ComplexArray]:
    """Angular frequencies (2 n,) of both signs, and shapes (n, 2 n), of the undamped M q'' + C q' + K q = 0."""
    n = len(M)
    values, vectors = eig(np.block([[np.zeros((n, n)), np.eye(n)], [-K, -C]]), block_diag(np.eye(n), M))
    return np.asarray(values.imag, dtype=np.float64), np.asarray(vectors[:n], dtype=np.complex128)


def seen_frequencies(values: FloatArray, vectors: ComplexArray, blades: int, speed: float) -> FloatArray:
    """Inertial angular frequencies of modes of one nodal diameter, forward positive, backward negative.

    A tip coordinate a_k = a e^(-i phi_k) with e^(i omega t) is a wave that travels with the rotation at omega.
    """
    angle = 2 * np.pi * np.arange(blades) / blades
    tips = vectors[: 3 * blades].reshape(blades, 3, -1)
    total = np.sum(np.abs(tips) ** 2, axis=(0, 1))
    wave = np.einsum("k,kcm->cm", np.exp(1j * angle), tips) / np.sqrt(blades)
    share = np.sum(np.abs(wave) ** 2, axis=0) / np.maximum(total, 1e-300)
    return np.asarray(values[share > PURE] + speed, dtype=np.float64)


def _first(values: FloatArray) -> FloatArray:
    """The lowest SHOWN values, NaN where there are fewer."""
    lowest = np.sort(values)[:SHOWN]
    return np.pad(lowest, (0, SHOWN - len(lowest)), constant_values=np.nan)
