"""What a model shows whose blades turn and whose disk does not: an experiment on the second crossing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rubgen.arrays import FloatArray, SparseMatrix
from rubgen.fem.blisk import rigid_motions
from rubgen.fem.constraints import on_springs, support_stiffness
from rubgen.units import rad_per_s
from validation.piece import Arrays
from validation.zeng2019.models.full import blisk_modes, full_blisk
from validation.zeng2019.models.reduced import SHOWN, seen_frequencies, whirl

BASIS = 130
"""Modes of the full blisk at rest that carry the experiment."""
MODELS = ("consistent", "mixed", "halved")


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
    centre: FloatArray


def crossings_by_frame(stiffnesses: list[float], speed_rpm: float) -> Arrays:
    """Frequencies (s, 12) of one nodal diameter over the lateral stiffness `k` (s,), as each model draws them, in Hz.

    `consistent`: all matrices of the turning frame, forward whirl seen from the inertial one. `mixed`: the blades keep
    Coriolis and spin softening of their turning axes, the disk has the gyroscopic matrix of its sections' polar inertia
    in the inertial frame, and both are joined as they are; every frequency is drawn. `halved`: the same with Omega G
    in place of 2 Omega G for the blades.
    """
    parts, speed = _parts(), rad_per_s(speed_rpm)
    drawn = {
        name: np.array([_drawn(parts, C, _on_support(parts, K, k), speed, name) for k in stiffnesses])
        for name, (C, K) in _models(parts, speed).items()
    }
    return {"k": np.array(stiffnesses)} | drawn


def points_by_frame(stiffnesses: list[float], speed_rpm: float) -> Arrays:
    """x of the disk centre (s,) once a turn over the lateral stiffness `k` (s,), with each of the same models, in m.

    The answer to the preset's unbalance without rub, with the dampers of the lateral support alone. It turns with the
    unbalance: at rest in the turning frame, circular in the inertial one.
    """
    parts, speed = _parts(), rad_per_s(speed_rpm)
    machine, model = full_blisk()
    x, y = parts.centre
    shift = rigid_motions(model)[:, 0]
    mass = float(shift @ (model.M @ shift))
    force = speed**2 * machine.unbalance_kg_m
    found: dict[str, list[float]] = {name: [] for name in MODELS}
    for k in stiffnesses:
        damper = 2 * machine.damping.lateral * np.sqrt(k * mass)
        for name, (C, K) in _models(parts, speed).items():
            stiffness = _on_support(parts, K, k)
            if name == "consistent":
                turned = speed * damper * (np.outer(y, x) - np.outer(x, y))
                found[name].append(float(x @ np.linalg.solve(stiffness + turned, force * x)))
            else:
                dynamic = stiffness - speed**2 * parts.M + 1j * speed * (C + damper * parts.lateral)
                found[name].append(float((x @ np.linalg.solve(dynamic, force * (x - 1j * y))).real))
    return {"k": np.array(stiffnesses)} | {name: np.array(points) for name, points in found.items()}


def _models(parts: _Parts, speed: float) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Damping and stiffness beside K of each of MODELS."""
    centrifugal, spin = speed**2 * (parts.K_sigma - parts.S_blades), 2 * speed * parts.G_spin
    made = (
        (2 * speed * (parts.G_blades + parts.G_disk), centrifugal - speed**2 * parts.S_disk),
        (2 * speed * parts.G_blades + spin, centrifugal),
        (speed * parts.G_blades + spin, centrifugal),
    )
    return dict(zip(MODELS, made, strict=True))


def _on_support(parts: _Parts, K: FloatArray, k: float) -> FloatArray:
    return np.asarray(parts.K + K + (k - 1e8) * parts.lateral)


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
        centre=V[:2],
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
