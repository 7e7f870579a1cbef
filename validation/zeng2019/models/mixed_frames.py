"""What a model shows whose blades turn and whose disk does not: an experiment on the second crossing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rubgen.arrays import FloatArray, SparseMatrix
from rubgen.fem.constraints import on_springs, support_stiffness
from rubgen.units import rad_per_s
from validation.piece import Arrays
from validation.zeng2019.models.full import blisk_modes, full_blisk
from validation.zeng2019.models.reduced import SHOWN, seen_frequencies, whirl

BASIS = 130
"""Modes of the full blisk at rest that carry the experiment."""


@dataclass(frozen=True, kw_only=True)
class _Parts:
    """The blisk on its modes at rest: blades and disk apart where they turn. `lateral` is what 1 N/m more adds."""

    M: FloatArray
    K: FloatArray
    lateral: FloatArray
    G_blades: FloatArray
    G_disk: FloatArray
    G_spin: FloatArray
    S_blades: FloatArray
    S_disk: FloatArray
    K_sigma: FloatArray
    tips: FloatArray


def crossings_by_frame(stiffnesses: list[float], speed_rpm: float) -> Arrays:
    """Frequencies (s, 12) of one nodal diameter over the lateral stiffness `k` (s,), as each model draws them, in Hz.

    `consistent`: all matrices of the turning frame, forward whirl seen from the inertial one. `mixed`: the blades keep
    Coriolis and spin softening of their turning axes, the disk has the gyroscopic matrix of its sections' polar inertia
    in the inertial frame, and both are joined as they are; every frequency is drawn. `halved`: the same with Omega G
    in place of 2 Omega G for the blades.
    """
    parts, speed = _parts(), rad_per_s(speed_rpm)
    centrifugal = speed**2 * (parts.K_sigma - parts.S_blades)
    spin = 2 * speed * parts.G_spin
    models = {
        "consistent": (2 * speed * (parts.G_blades + parts.G_disk), centrifugal - speed**2 * parts.S_disk),
        "mixed": (2 * speed * parts.G_blades + spin, centrifugal),
        "halved": (speed * parts.G_blades + spin, centrifugal),
    }
    drawn = {
        name: np.array([_drawn(parts, C, parts.K + K + (k - 1e8) * parts.lateral, speed, name) for k in stiffnesses])
        for name, (C, K) in models.items()
    }
    return {"k": np.array(stiffnesses)} | drawn


def _parts() -> _Parts:
    machine, model = full_blisk()
    V = blisk_modes(BASIS).shapes
    of_disk = np.arange(len(V)) < model.disk_size
    turns = of_disk & (np.arange(len(V)) % 6 >= 3)

    def on(X: SparseMatrix, chosen: np.ndarray | None = None) -> FloatArray:
        W = V if chosen is None else sp.diags_array(chosen.astype(float)) @ V
        return np.asarray(W.T @ (X @ W))

    return _Parts(
        M=on(model.M),
        K=on(on_springs(model.K, support_stiffness(machine.disk_support))),
        lateral=V[:2].T @ V[:2],
        G_blades=on(model.G, ~of_disk),
        G_disk=on(model.G, of_disk),
        G_spin=on(model.G, turns),
        S_blades=on(model.S, ~of_disk),
        S_disk=on(model.S, of_disk),
        K_sigma=on(model.K_sigma),
        tips=V[model.tips[:, :3]].reshape(-1, BASIS),
    )


def _drawn(parts: _Parts, C: FloatArray, K: FloatArray, speed: float, name: str) -> FloatArray:
    """The first frequencies of one nodal diameter, in Hz."""
    values, vectors = whirl(parts.M, C, K)
    tips, blades = parts.tips @ vectors, len(parts.tips) // 3
    if name == "consistent":
        seen = seen_frequencies(values, tips, blades, speed)
        found = seen[seen > 0]
    else:
        found = np.abs(seen_frequencies(values, tips, blades, 0.0))
    shown = np.sort(found)[:SHOWN] / (2 * np.pi)
    return np.pad(shown, (0, SHOWN - len(shown)), constant_values=np.nan)
