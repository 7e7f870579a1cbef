"""Compute the largest Lyapunov exponent from the growth of the distance to a companion trajectory."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray

ALIGNING = 0.1
"""Share of the record in which the companion aligns with the direction of fastest growth; left out."""
BLOCKS = 10
BRIDGE_RANGE = np.sqrt(np.pi / 2)
"""Mean range of a Brownian bridge of unit variance over unit time."""


@dataclass(frozen=True, kw_only=True)
class Exponent:
    """The largest Lyapunov exponent of a motion, with its standard error."""

    per_turn: float
    """The exponent in 1/turn (or by the span of one growth)."""
    error: float
    """Its standard error in the same unit."""
    convergence: FloatArray
    """Its value (10,) from the first k tenths of the growths that count, k = 1..10. The last value is the exponent."""
    turns: int
    """Number of growths."""

    @property
    def is_positive(self) -> bool:
        """Whether the exponent is more than two standard errors above zero, and above LEAST."""
        return self.per_turn > max(2 * self.error, LEAST)

    @property
    def is_negative(self) -> bool:
        """Whether the exponent is more than two standard errors below zero, and below -LEAST."""
        return self.per_turn < -max(2 * self.error, LEAST)


ASKED_FROM, ASKED_EVERY = 150, 50
SETTLED_ERRORS, SETTLED_FROM = 6.0, 0.01
"""An exponent is settled where it is larger than so many of its errors and than this, in 1/turn."""
CHANGE, CHANGE_TURNS, MOST_LAG = 10.0, 100, 16
"""See `changed_after`; the lags are the periods that a motion may have, in turns."""
LEAST = 1e-3
"""Exponents within this of zero, in 1/turn, count as zero: over 500 turns a distance then grows at most 1.65 times."""


def lyapunov(growth: FloatArray) -> Exponent | None:
    """Compute the largest Lyapunov exponent: the mean of `growth` without its first tenth.

    Benettin, Galgani, Giorgilli, Strelcyn 1980, Meccanica 15, 9. For the error see `standard_error`.

    - growth (n,): ln of the growth of a companion's distance from one renormalisation to the next.

    Returns None for fewer than 20 growths after the first tenth, and where any growth is NaN or infinite: the companion
    then could not follow the run.
    """
    counted = growth[int(ALIGNING * growth.size) :]
    if counted.size < 2 * BLOCKS or not np.isfinite(growth).all():
        return None
    ends = np.cumsum([len(block) for block in np.array_split(counted, BLOCKS)])
    return Exponent(
        per_turn=float(counted.mean()),
        error=standard_error(counted),
        convergence=np.cumsum(counted)[ends - 1] / ends,
        turns=growth.size,
    )


def is_settled(growth: Sequence[float]) -> bool:
    """Return whether the exponent of the growths so far is settled: more growths would not change its sign.

    `growth` (n,) is the ln of the growth in each turn, as for `lyapunov`; n is at least 1. The exponent can be settled
    only at 150, 200, ... growths, if it is farther from zero than SETTLED_ERRORS standard errors and than SETTLED_FROM
    in 1/turn. A last growth that is NaN or infinite settles it at any number: there is then no exponent.
    """
    n = len(growth)
    if not math.isfinite(growth[-1]):
        return True
    if n < ASKED_FROM or n % ASKED_EVERY:
        return False
    exponent = lyapunov(np.array(growth))
    return exponent is not None and abs(exponent.per_turn) > max(SETTLED_ERRORS * exponent.error, SETTLED_FROM)


def changed_after(impulse: FloatArray, turns: int, exponent: float) -> bool:
    """Return whether the class of a motion has changed since its exponent was settled after `turns` turns.

    - impulse (n,): impulse of each turn of the record from its first, N s.
    - turns: number of first turns from which the exponent was computed, 100 at least.
    - exponent: its value in 1/turn. Only its sign is used.

    Chaos may be a transient, and a regular motion an episode. The deviation of successive turns is the rms difference
    of their impulses from the impulses p turns before, for the p = 1..16 where it is least. The 100 turns before
    `turns` are compared with each whole block of 50 turns after `turns`. A motion with a positive exponent has changed
    if the deviation falls to less than a tenth in any of these blocks. Any other motion has changed if it rises to more
    than ten times in any of them. With fewer than 50 later turns the result is False.

    Of 86 rubs of three recipes one changed: its deviation fell to rounding. In the other chaotic rubs the deviation
    changed by a factor of 0.34 to 2.2. In the regular rubs it fell.
    """
    before = _unlikeness(impulse[turns - CHANGE_TURNS : turns])
    starts = range(turns, len(impulse) - ASKED_EVERY + 1, ASKED_EVERY)
    after = [_unlikeness(impulse[start : start + ASKED_EVERY]) for start in starts]
    if exponent > 0:
        return any(each < before / CHANGE for each in after)
    return any(each > before * CHANGE for each in after)


def _unlikeness(impulse: FloatArray) -> float:
    """Return the rms difference of impulses (n,) from those some turns before, for the turns where it is least."""
    return min(float(np.sqrt(np.mean(np.square(impulse[lag:] - impulse[:-lag])))) for lag in range(1, MOST_LAG + 1))


def standard_error(growth: FloatArray) -> float:
    """Return the standard error of the mean of growths (n,) that follow each other in time; n is at least ten.

    It is the largest of three estimates. For each estimate there is a motion for which the two others are too small:

    - Chaos: the scatter of the means of ten blocks over sqrt(10). It allows for correlation from turn to turn.
    - Tori: range(S) / (n sqrt(pi / 2)), where S is the sum of the growths less its straight line from first to last. On
      a torus S is bounded, and the mean is wrong by at most about range(S) / n, which is 1.25 errors. Means of blocks
      do not show it. For independent growths S is a Brownian bridge with the mean range sqrt(pi n / 2) times their
      deviation (Feller 1951, Ann. Math. Statist. 22, 427), and the estimate is the standard error again.
    - Drifts: half of the difference between the means of the two halves.

    Checked on tori and on chaos in `tests/labels/test_lyapunov.py`.
    """
    blocks = [block.mean() for block in np.array_split(growth, BLOCKS)]
    first, second = (half.mean() for half in np.array_split(growth, 2))
    from_line = np.cumsum(growth - growth.mean(), dtype=np.float64)
    return float(
        max(
            np.std(blocks, ddof=1) / np.sqrt(BLOCKS),
            np.ptp([0.0, *from_line]) / (growth.size * BRIDGE_RANGE),
            abs(second - first) / 2,
        )
    )
