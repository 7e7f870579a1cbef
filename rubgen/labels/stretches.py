"""The class of motion of each window of a record: what can be said of a stretch of 16 turns."""

from __future__ import annotations

import numpy as np

from rubgen.labels.labels import Motion
from rubgen.labels.motion.classify import Motions
from rubgen.labels.motion.drifting import drifting_motion
from rubgen.labels.speed_history import SpeedHistory, rubbing
from rubgen.labels.windows import turn_times, window_edges
from rubgen.solver.response import Response

NOT_KNOWN = (Motion.UNDECIDED, None)


def window_motions(
    response: Response, whole: Motions, history: SpeedHistory | None
) -> tuple[tuple[Motion, float | None], ...]:
    """Return class and confidence of the motion in each window of 16 turns. The confidence is None where it is unknown.

    - response: the response of the whole record.
    - whole: the motion of the whole record.
    - history: its changes, where the speed changes; else None.

    A motion that repeats or is quasi-periodic over the whole record has that class in every window. A motion that is
    chaotic or undecided as a whole has stretches, regular and irregular. A window within a regular stretch is period-1
    or period-k, with unknown confidence. A window within an irregular stretch has the class of the whole record. A
    window across the end of a stretch is undecided.

    While the speed changes, a window has the class from `history` if it is the same throughout the window, and is
    undecided otherwise. While a fault grows and the motion of the whole is undecided, it has the class of
    `drifting_motion`. Both have unknown confidence.
    """
    edges = window_edges(response)
    windows = list(zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True))
    if history is not None:
        return _of_changes(response, history)
    system = whole.system
    if response.grows and system.motion is Motion.UNDECIDED:
        rubs = rubbing(response)
        found = (drifting_motion(response, a, b, rub=bool(rubs[a:b].any())).system.motion for a, b in windows)
        return tuple((motion, None) for motion in found)
    sure = None if system.motion is Motion.UNDECIDED else system.confidence
    if not whole.stretches:
        return ((system.motion, sure),) * len(windows)
    named: list[tuple[Motion, float | None]] = []
    for first, last in windows:
        period = next((each.period for each in whole.stretches if each.start <= first and last <= each.end), None)
        if period is None:
            named.append(NOT_KNOWN)
        elif period == 0:
            named.append((system.motion, sure))
        else:
            named.append((Motion.PERIOD_1 if period == 1 else Motion.PERIOD_K, None))
    return tuple(named)


def _of_changes(response: Response, history: SpeedHistory) -> tuple[tuple[Motion, float | None], ...]:
    times = turn_times(response, response.changing_speed)[window_edges(response)]
    begins = np.array([change.time for change in history.changes])
    first = np.maximum(np.searchsorted(begins, times[:-1], side="right") - 1, 0)
    last = np.searchsorted(begins, times[1:], side="left")
    found = []
    for a, b in zip(first.tolist(), last.tolist(), strict=True):
        classes = {change.motion for change in history.changes[a:b]}
        found.append((classes.pop(), None) if len(classes) == 1 else NOT_KNOWN)
    return tuple(found)
