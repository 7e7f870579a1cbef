"""A search for what the paper does not publish: contact surface, mass and springs of the casing, friction, damping."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

from validation.onset import Surface
from validation.zeng2019.fitting.candidate import PRESET, Candidate

SURFACE: tuple[Surface, ...] = ("smooth", "chords")
MASS = (1.0, 2.0, 3.5, 5.0, 8.0, 10.0, 12.0)
"""Times the lightest reading of the casing, of which the preset has five."""
DAMPING = (0.05, 0.10, 0.15)
FRICTION = (0.0, 0.02, 0.05, 0.1, 0.2)
SPRINGS = (0.5, 1.0, 2.3)
"""Springs of the casing outside of its own sweep, times those with which it has the published frequencies. 2.3 is the
middle of the range in which the paper's sweep of the casing's support has period-1 motion, 2.09e4 to 2.63e4 N/m."""


def grid() -> list[Candidate]:
    """Surface, mass and damping without friction, with the springs of the frequencies; the preset comes first."""
    every = [Candidate(surface=s, mass=m, damping=d) for s, m, d in product(SURFACE, MASS, DAMPING)]
    return [PRESET, *(one for one in every if one != PRESET)]


def around(found: Candidate) -> list[Candidate]:
    """The same surface, mass and damping with each other friction and springs."""
    every = [replace(found, friction=f, springs=k) for f, k in product(FRICTION, SPRINGS)]
    return [one for one in every if one != found]
