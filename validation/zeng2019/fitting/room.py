"""What the published facts leave to unbalance and clearance."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
from scipy.optimize import brentq

from rubgen.machine import Machine
from validation.onset import tip_growth
from validation.piece import Arrays
from validation.zeng2019.fitting.candidate import Candidate, machine_of
from validation.zeng2019.runs.cases import END_OF_RUB, ONSET_RPM, SUPPORT_RPM


def room(damping: float) -> Arrays:
    """`unbalance` in kg m and `clearance` in m: least and largest that the published facts leave at that damping.

    They are among the four pairs in which the tips just touch at one end of the interval of onset, 6,660 or 6,780
    rev/min, and at one end of that of the end of rub at 10,000 rev/min, 6.70e8 or 6.75e8 N/m.
    """
    machine = machine_of(Candidate(damping=damping))
    pairs = np.array([_touching(machine, rpm, k) for rpm, k in product(ONSET_RPM, END_OF_RUB)])
    least, largest = pairs.min(axis=0), pairs.max(axis=0)
    return {"unbalance": np.array([least[0], largest[0]]), "clearance": np.array([least[1], largest[1]])}


def _touching(machine: Machine, rpm: float, stiffness: float) -> tuple[float, float]:
    """Unbalance and clearance with which tips just touch at that speed, and on that support at 10,000 rev/min."""
    stiff = replace(machine, disk_support=replace(machine.disk_support, lateral_stiffness_n_per_m=stiffness))

    def apart(unbalance: float) -> float:
        there = tip_growth(replace(machine, unbalance_kg_m=unbalance), rpm)
        return there - tip_growth(replace(stiff, unbalance_kg_m=unbalance), SUPPORT_RPM)

    unbalance = float(brentq(apart, 1e-4, 1.0, xtol=1e-8))
    return unbalance, tip_growth(replace(machine, unbalance_kg_m=unbalance), rpm)
