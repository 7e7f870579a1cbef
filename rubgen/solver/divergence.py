"""How fast a run that diverges has grown."""

from __future__ import annotations

import math
from collections import deque

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.reduction.model import SpinningSystem

GROWTH_TURNS = 10
"""Rates of growth are those of this many last turns."""


class Growth:
    """Amplitudes of casing and blade tips over the last turns.

    Of the casing the largest bound of its displacement within the turn, of the blades the largest tip coordinate at its
    first step, both in m.
    """

    def __init__(self, system: SpinningSystem) -> None:
        self.tips = 3 * system.n_blades
        self.trail: deque[tuple[float, float]] = deque(maxlen=GROWTH_TURNS + 1)

    def add(self, casing: float, q: FloatArray) -> None:
        """One turn more: the casing's largest bound, and q (n,) at the turn's first step."""
        self.trail.append((casing, float(np.abs(q[: self.tips]).max())))

    def rates(self, turn_seconds: float) -> str:
        """Growth of both over the last turns in words, with the rates a turn and a second."""
        amplitudes = np.array(self.trail).reshape(-1, 2)
        rates = {name: growth_rate(amplitudes[:, column]) for name, column in (("blades", 1), ("casing", 0))}
        told = [
            f"{name} {rate:+.3g} a turn ({rate / turn_seconds:+.3g} 1/s)"
            for name, rate in rates.items()
            if math.isfinite(rate)
        ]
        if not told:
            return "too soon to tell a rate of growth"
        return f"rate of growth over the last {len(amplitudes) - 1} turns: {', '.join(told)}"


def growth_rate(amplitudes: FloatArray) -> float:
    """Rate s of the growth exp(s k) of amplitudes (n,), by least squares on their logarithms; NaN where none grows.

    Amplitudes that are zero or no number are left out.
    """
    known = np.isfinite(amplitudes) & (amplitudes > 0)
    if known.sum() < 2:
        return math.nan
    return float(np.polyfit(np.flatnonzero(known), np.log(amplitudes[known]), 1)[0])
