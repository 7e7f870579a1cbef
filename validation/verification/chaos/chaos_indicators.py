"""The 0-1 test for chaos on maps whose nature is known.

K tends to 1 for chaos and to 0 for regular motion. The damped variant (Gottwald and Melbourne 2009) is tested with
500 points of a section, as for labels. It is within 0.025 of 1 for strongly chaotic maps; its own limit for a map
without memory is 0.992. It is within 0.05 of 0 for periodic and quasi-periodic motion.
With the 49 points of the published diagrams it fails: most rotations of a circle then look chaotic. This is why
labels use 500 points.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.labels.motion.chaos import growth_correlation
from validation.verification.row import Row, within

TITLE = "0-1 test for chaos"
POINTS, TRANSIENT = 500, 200
GOLDEN = (np.sqrt(5) - 1) / 2


def logistic(r: float) -> FloatArray:
    """500 points of x -> r x (1 - x)."""
    x, orbit = 0.3, []
    for _ in range(POINTS + TRANSIENT):
        x = r * x * (1 - x)
        orbit.append(x)
    return np.array(orbit[TRANSIENT:])


def henon() -> FloatArray:
    """500 points of Henon's map with a = 1.4, b = 0.3."""
    x, y, orbit = 0.1, 0.1, []
    for _ in range(POINTS + TRANSIENT):
        x, y = 1 - 1.4 * x * x + y, 0.3 * x
        orbit.append(x)
    return np.array(orbit[TRANSIENT:])


def circle_map(rotation: float, points: int = POINTS) -> FloatArray:
    """Cosines of an angle that grows by `rotation` turns each time: quasi-periodic."""
    return np.asarray(np.cos(2 * np.pi * rotation * np.arange(TRANSIENT, TRANSIENT + points)))


def rows() -> Iterator[Row]:
    """Chaotic, periodic and quasi-periodic maps."""
    source = "chaotic: K = 1"
    yield within("0-1 test: K of the logistic map, r = 4", source, 1.0, growth_correlation(logistic(4.0)), 0.025)
    yield within("0-1 test: K of Henon's map", source, 1.0, growth_correlation(henon()), 0.025)
    source = "regular: K = 0"
    found = growth_correlation(logistic(3.5))
    yield within("0-1 test: K of the logistic map of period 4, r = 3.5", source, 0.0, found, 0.05)
    found = growth_correlation(circle_map(GOLDEN))
    yield within("0-1 test: K of a golden rotation of the circle", source, 0.0, found, 0.05)
    rotations = np.random.default_rng(0).uniform(0.02, 0.98, 60)
    found = max((growth_correlation(circle_map(r)) for r in rotations), key=abs)
    yield within("0-1 test: K largest in size of 60 rotations", source, 0.0, found, 0.05)
    found = growth_correlation(circle_map(GOLDEN, 49))
    yield within("0-1 test: K of the same rotation on 49 points", "wrongly chaotic: K = 0.99", 0.99, found, 0.02)
