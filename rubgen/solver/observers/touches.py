"""Touches of blades as arrays."""

from __future__ import annotations

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.solver.response import ContactEvents, TipArrivals
from rubgen.solver.scheme.turn_kernels import BLADE, COSINE, FRICTION_LOSS, IMPULSE, NORMAL_LOSS, SINE, START, STEPS


def contact_events(touches: list[FloatArray]) -> ContactEvents:
    """Touches (each array (any, 8) with the columns of `turn_kernels`) in order of their last step, then of blade."""
    rows = np.concatenate([np.zeros((0, 8)), *touches])
    rows = rows[np.lexsort((rows[:, BLADE], rows[:, START] + rows[:, STEPS]))]
    angle = np.mod(np.arctan2(rows[:, SINE], rows[:, COSINE]), 2 * np.pi)
    return ContactEvents(
        blade=rows[:, BLADE].astype(np.int64),
        start_step=rows[:, START].astype(np.int64),
        steps=rows[:, STEPS].astype(np.int64),
        angle=np.where(angle < 2 * np.pi, angle, 0.0),  # a tiny negative angle rounds up to the whole turn
        impulse=rows[:, IMPULSE].copy(),
        friction_loss=rows[:, FRICTION_LOSS].copy(),
        normal_loss=rows[:, NORMAL_LOSS].copy(),
    )


def tip_arrivals(arrivals: list[FloatArray], names: list[str]) -> dict[str, TipArrivals]:
    """Arrivals (each array (any, 4): number of the probe, blade, step, displacement) by probe, in order of time."""
    rows = np.concatenate([np.zeros((0, 4)), *arrivals])
    seen = {}
    for number, name in enumerate(names):
        own = rows[rows[:, 0] == number]
        own = own[np.argsort(own[:, 2], kind="stable")]
        seen[name] = TipArrivals(blade=own[:, 1].astype(np.int64), step=own[:, 2].copy(), displacement=own[:, 3].copy())
    return seen
