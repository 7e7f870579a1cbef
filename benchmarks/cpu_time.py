"""The one statistic of all tables: the median CPU time of this process over several rounds."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np


def cpu_time(work: Callable[[], object]) -> float:
    """CPU time of one call in s."""
    begun = time.process_time()
    work()
    return time.process_time() - begun


def median_time(work: Callable[[], object], rounds: int) -> float:
    """Median CPU time of so many calls in s."""
    return float(np.median([cpu_time(work) for _ in range(rounds)]))
