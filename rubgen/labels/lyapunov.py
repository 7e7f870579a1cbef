"""The largest Lyapunov exponent from the growth of the distance to a twin trajectory."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.solver.response import Response

ALIGNING = 0.1
"""Share of the record in which the twin turns into the direction of fastest growth; left out."""
BLOCKS = 10


@dataclass(frozen=True, kw_only=True)
class Exponent:
    """The largest Lyapunov exponent and its standard error, in 1/turn (or by whatever one growth spans).

    `convergence` (10,) is its value from the first tenth of the growths that count, from the first two tenths, and so
    on: the last is the exponent.
    """

    per_turn: float
    error: float
    convergence: FloatArray

    @property
    def is_positive(self) -> bool:
        """More than two standard errors above zero, and more than can be told from it."""
        return self.per_turn > max(2 * self.error, LEAST)

    @property
    def is_negative(self) -> bool:
        """The same below zero."""
        return self.per_turn < -max(2 * self.error, LEAST)


LEAST = 1e-3
"""Exponents within this of zero, in 1/turn, are zero: what is nearer grows less than half over 500 turns."""


def lyapunov(growth: FloatArray) -> Exponent | None:
    """The exponent of a trajectory whose twin's distance grew by exp(growth) (n,) from one renormalisation to the next.

    The mean of the growths but for the first tenth (Benettin, Galgani, Giorgilli, Strelcyn 1980, Meccanica 15, 9). Its
    standard error comes from the means of ten blocks, which correlation from turn to turn does not fool as it does the
    scatter of single turns, and it is no less than half of what the two halves differ by: a drift is an error too.
    None without growths, or where one is no number: the twin could not follow.
    """
    counted = growth[int(ALIGNING * growth.size) :]
    if counted.size < 2 * BLOCKS or not np.isfinite(growth).all():
        return None
    blocks = np.array([block.mean() for block in np.array_split(counted, BLOCKS)])
    halves = [half.mean() for half in np.array_split(counted, 2)]
    ends = np.cumsum([len(block) for block in np.array_split(counted, BLOCKS)])
    return Exponent(
        per_turn=float(counted.mean()),
        error=float(max(blocks.std(ddof=1) / np.sqrt(BLOCKS), abs(halves[1] - halves[0]) / 2)),
        convergence=np.cumsum(counted)[ends - 1] / ends,
    )


def lyapunov_of(response: Response) -> Exponent | None:
    """The exponent of a run; None where none was asked for."""
    return lyapunov(response.twin_growth)
