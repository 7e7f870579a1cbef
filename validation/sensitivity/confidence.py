"""What half the step does to the indicators of motion and to its class, and how often a confidence is right."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from rubgen.labels.labels import Motion
from rubgen.labels.motion.chaos import CHAOTIC_FROM
from rubgen.labels.motion.decision import Indicators
from validation.sensitivity.recipes import Halved

SURE = 0.9
KEPT_WHERE_SURE = 0.97
"""Share of the runs with a confidence of SURE or more that must keep their class."""
BINS = (0.0, 0.5, 0.7, 0.9, 0.95, 1.0)
ROUNDING = 1e-6
"""Strays below this are the rounding of a single-precision section."""


@dataclass(frozen=True, kw_only=True)
class Bin:
    """Runs with a confidence from `low` to below `high` (1 included): their number, how many keep their class."""

    low: float
    high: float
    runs: int
    kept: int
    mean_confidence: float

    @property
    def interval(self) -> tuple[float, float]:
        """The share of kept classes, one standard error below and above it."""
        return interval(self.kept, self.runs, 1.0)


def interval(kept: int, runs: int, deviates: float = 1.96) -> tuple[float, float]:
    """Wilson's interval of a share (J. Am. Stat. Assoc. 22, 1927, 209); 1.96 deviates are 95 %."""
    share, z = kept / runs, deviates**2 / runs
    centre, half = share + z / 2, deviates * math.sqrt(share * (1 - share) / runs + z / (4 * runs))
    return max((centre - half) / (1 + z), 0.0), min((centre + half) / (1 + z), 1.0)


def bins(pairs: Sequence[Halved]) -> list[Bin]:
    """The bins that have runs; a run that is undecided has no class to keep and is in none."""
    decided = [pair for pair in pairs if pair.whole.system.motion is not Motion.UNDECIDED]
    found = []
    for low, high in zip(BINS, (*BINS[1:-1], 1.1), strict=False):
        inside = [pair for pair in decided if low <= pair.confidence < high]
        if inside:
            kept, mean = sum(pair.kept for pair in inside), float(np.mean([pair.confidence for pair in inside]))
            found.append(Bin(low=low, high=min(high, 1.0), runs=len(inside), kept=kept, mean_confidence=mean))
    return found


def sure(pairs: Sequence[Halved]) -> tuple[int, int]:
    """How many runs have a confidence of SURE or more, and how many of them keep their class."""
    inside = [pair for pair in pairs if pair.confidence >= SURE]
    return len(inside), sum(pair.kept for pair in inside)


@dataclass(frozen=True, kw_only=True)
class Spread:
    """Root mean square of what half the step changes, the median of its size, and the number of pairs."""

    rms: float
    median: float
    pairs: int


def spreads(pairs: Sequence[Halved]) -> dict[str, Spread]:
    """What half the step does to stray and exponent (decades) and to K; parts by what strays in them."""
    parts = [part for pair in pairs for part in zip(pair.whole.indicators, pair.half.indicators, strict=False)]
    systems = [(pair.whole.indicators[0], pair.half.indicators[0]) for pair in pairs]
    positive = [pair for pair in systems if all(_grows(one) for one in pair)]
    changes: dict[str, list[float]] = {
        "stray, the rest regular": _changes([p for p in parts if not any(map(_chaotic, p)) and _seen(p)], _stray),
        "stray, the rest chaotic": _changes([p for p in parts if any(map(_chaotic, p)) and _seen(p)], _stray),
        "K": _changes(systems, lambda one: one.growth),
        "exponent, positive": _changes(positive, lambda one: math.log10(one.exponent.per_turn)),  # type: ignore[union-attr]
    }
    return {name: _spread(values) for name, values in changes.items() if values}


def shared(pair: Halved) -> str:
    """What a run that loses its class has, by the most telling of its indicators."""
    first, parts = pair.whole.indicators[0], pair.whole.indicators
    if not first.resolved:
        return "half of the touches shorter than four steps"
    if all(part.period is not None for part in parts):
        if not _chaotic(first) and any(part.period != 1 for part in parts):
            return "repeats after several turns, the rest regular"
        return "repeats, the rest chaotic" if _chaotic(first) else "repeats every turn, the rest regular"
    return "does not repeat, chaotic" if _chaotic(first) else "does not repeat, not chaotic"


def _chaotic(one: Indicators) -> bool:
    return one.growth >= CHAOTIC_FROM and _grows(one)


def _grows(one: Indicators) -> bool:
    return one.exponent is not None and one.exponent.is_positive


def _seen(pair: tuple[Indicators, Indicators]) -> bool:
    return min(one.stray for one in pair) > ROUNDING


def _stray(one: Indicators) -> float:
    return math.log10(one.stray)


def _changes(pairs: Sequence[tuple[Indicators, Indicators]], read: Callable[[Indicators], float]) -> list[float]:
    return [read(half) - read(whole) for whole, half in pairs]


def _spread(values: Sequence[float]) -> Spread:
    sizes = np.abs(values)
    return Spread(rms=float(np.sqrt(np.mean(sizes**2))), median=float(np.median(sizes)), pairs=len(values))
