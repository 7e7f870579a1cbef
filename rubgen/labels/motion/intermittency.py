"""Find motion that switches between regular and irregular."""

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import BoolArray, FloatArray
from rubgen.labels.motion.clusters import EXCURSION, LONGEST_PERIOD, farthest

SHORTEST = 10
"""Least number of turns of a segment. A regular segment also has at least three periods."""
LEAST_SHARE = 0.1
"""Least share of the record for each of both kinds."""


@dataclass(frozen=True, kw_only=True)
class Segment:
    """Turns `start` .. `end` - 1 of the record that repeat after `period` turns; 0 where they do not repeat."""

    start: int
    end: int
    period: int


def segments(parts: list[FloatArray]) -> list[Segment]:
    """Cut the record where its motion becomes regular or irregular, and return the segments in order.

    - parts: the points (turns, groups, values) of blisk and casing, each divided by the size of its motion.

    A segment is regular with period k, at most 16 and a quarter of the turns, if each point returns after k turns
    within EXCURSION, in every part and group, for at least 10 + k turns and 3 k turns. Each turn has the smallest such
    k. An irregular segment below 10 turns joins the segment before it.
    """
    turns = len(parts[0])
    period = np.zeros(turns, dtype=np.int64)
    for k in range(min(LONGEST_PERIOD, turns // 4), 0, -1):
        back = np.max([farthest(part[k:] - part[:-k]) for part in parts], axis=0)
        for first, last in _stretches(back <= EXCURSION):
            if last - first >= max(SHORTEST, 2 * k):
                period[first : last + k] = k
    return _joined(_cut(period))


def is_intermittent(found: list[Segment]) -> bool:
    """Return whether a motion with the segments `found` switches: at least two are regular and one is irregular.

    The regular segments together, and the irregular ones, must have at least a tenth of the turns.
    """
    regular = [segment.period > 0 for segment in found]
    turns = found[-1].end - found[0].start
    share = sum(segment.end - segment.start for segment in found if segment.period) / turns
    return sum(regular) >= 2 and not all(regular) and LEAST_SHARE <= share <= 1 - LEAST_SHARE


def _stretches(flags: BoolArray) -> list[tuple[int, int]]:
    """Return the first and one past the last index of each run of true values."""
    edges = np.diff(np.concatenate([[0], flags.astype(np.int8), [0]]))
    return list(zip(np.flatnonzero(edges == 1).tolist(), np.flatnonzero(edges == -1).tolist(), strict=True))


def _cut(period: np.ndarray) -> list[Segment]:
    starts = [0, *(np.flatnonzero(np.diff(period)) + 1).tolist()]
    ends = [*starts[1:], len(period)]
    return [Segment(start=a, end=b, period=int(period[a])) for a, b in zip(starts, ends, strict=True)]


def _joined(cut: list[Segment]) -> list[Segment]:
    """Join irregular segments shorter than SHORTEST to their neighbours, and neighbours of one period."""
    out: list[Segment] = []
    for segment in cut:
        short = segment.period == 0 and segment.end - segment.start < SHORTEST
        if out and (short or segment.period == out[-1].period):
            out[-1] = Segment(start=out[-1].start, end=segment.end, period=out[-1].period)
        else:
            out.append(segment)
    return out
