"""What the statements ask of a run or of a sweep."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.labels import Motion
from validation.zeng2019.runs.outcome import Outcome

LINES_PER_ORDER = 100
EYE = 0.02
"""Points that scatter over less than this share of their diagram's height look like one."""
PARTS = {"blisk": "motion_centre", "tips": "motion_blisk", "casing": "motion_casing"}
"""Parts of the machine and their class: the paper's blisk is its disk centre; `tips` are the disk centre and all tips.
"""
PROMINENT = 0.01
"""A line is visible in a cascade from a hundredth of the run's strongest line on."""
CLOSE = 0.05
"""Lines nearer than this to a whole order belong to it."""


def harmonics(spectrum: FloatArray) -> FloatArray:
    """Amplitudes (10,) at orders 1 to 10 of a spectrum by hundredths of an order."""
    return np.asarray(spectrum[LINES_PER_ORDER::LINES_PER_ORDER], dtype=np.float64)


def strongest(amplitudes: FloatArray, least: int = 1) -> int:
    """The order of the largest amplitude from `least` on; amplitudes begin with order 1. 0 where all vanish."""
    part = amplitudes[least - 1 :]
    return least + int(np.argmax(part)) if part.any() else 0


def rms(run: Outcome, part: str) -> float:
    """Rms of a part, `blisk` or `casing`, over the last 49 turns, without the mean."""
    return float(getattr(run, f"{part}_rms"))


def strongest_line(run: Outcome, part: str) -> float:
    """The largest amplitude of a part at whole orders."""
    return float(harmonics(getattr(run, f"spectrum_{part}")).max())


def fractional(spectrum: FloatArray, least: int = 0) -> float:
    """The largest amplitude off whole orders (from 0.1 on) over the largest of all; 0 for silence.

    With `least` over the largest at the orders from that one on.
    """
    order = np.arange(len(spectrum)) / LINES_PER_ORDER
    off = (np.abs(order - np.round(order)) > CLOSE) & (order >= 0.1)
    top = float(harmonics(spectrum)[least - 1 :].max() if least else spectrum[order >= 0.1].max())
    return float(spectrum[off].max()) / top if top > 0 else 0.0


def height(runs: Collection[Outcome], part: str) -> float:
    """Height of the diagram of 49 points: largest less smallest of all of them. `part` is `blisk` or `casing`."""
    points = np.concatenate([np.zeros(1), *(getattr(run, f"points_{part}") for run in runs)])
    return float(np.ptp(points[1:])) if len(points) > 1 else 0.0


def scatter(run: Outcome, part: str, full_height: float) -> float:
    """Largest less smallest of the 49 points over the height of their diagram; 0 in a diagram without height."""
    return float(np.ptp(getattr(run, f"points_{part}"))) / full_height if full_height else 0.0


def looks_regular(run: Outcome, part: str, full_height: float) -> bool:
    """Whether the 49 points look like one in a diagram of that height."""
    return run.ok and scatter(run, part, full_height) <= EYE


def motion_of(run: Outcome, part: str) -> str:
    """Motion class of one of PARTS; the status of a failed run."""
    return str(getattr(run, PARTS[part])) if run.ok else run.status


def class_counts(runs: Collection[Outcome], part: str) -> str:
    """`12 period-1, 30 chaotic`, the most regular first."""
    counts = Counter(motion_of(run, part) for run in runs)
    known = [motion.value for motion in Motion]
    names = sorted(counts, key=lambda name: known.index(name) if name in known else len(known))
    return ", ".join(f"{counts[name]} {name}" for name in names)


def rubbing(runs: dict[float, Outcome]) -> dict[float, Outcome]:
    """The runs that ended well and rub."""
    return {value: run for value, run in runs.items() if run.ok and run.rub}


def segments(values: Sequence[float], names: Sequence[str], least: int) -> list[tuple[str, float, float]]:
    """Name, first and last value of each stretch of the same name; shorter ones than `least` join into `mixed`."""
    found: list[tuple[str, float, float, int]] = []
    for value, name in zip(values, names, strict=True):
        if found and found[-1][0] == name:
            found[-1] = (name, found[-1][1], value, found[-1][3] + 1)
        else:
            found.append((name, value, value, 1))
    joined: list[tuple[str, float, float]] = []
    for name, first, last, count in found:
        shown = name if count >= least else "mixed"
        if joined and joined[-1][0] == shown:
            joined[-1] = (shown, joined[-1][1], last)
        else:
            joined.append((shown, first, last))
    return joined
