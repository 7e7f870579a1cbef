"""Touches of blades as arrays."""

from __future__ import annotations

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.solver.response import ContactEvents
from rubgen.solver.turn_kernels import BLADE, COSINE, FRICTION_LOSS, IMPULSE, NORMAL_LOSS, SINE, START, STEPS


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
