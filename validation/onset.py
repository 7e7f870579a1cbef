"""Where rubbing begins, from the rub-free motion alone: the fit of the preset's unbalance and clearance.

Neither is published. Two published facts fix them: rubbing begins between 6,660 and 6,780 rev/min, and at
10,000 rev/min it has disappeared at a lateral support stiffness of 6.75e8 N/m.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from scipy.optimize import brentq

from rubgen.machine import Machine
from rubgen.reduction import reduce
from rubgen.scenario import Reduction
from rubgen.units import rad_per_s

ONSET_RPM = 6720.0
END_OF_RUB_RPM = 10000.0
END_OF_RUB_STIFFNESS = 6.75e8
AIR_AT_END_OF_RUB = 1e-6
Surface = Literal["smooth", "chords"]


def tip_growth(machine: Machine, speed_rpm: float) -> float:
    """Largest outward displacement of a tip in steady rotation without contact, in m.

    max_k |P_k| - tip radius, P_k from the steady centrifugal field and the static solve K(Omega) q = Omega^2 U e_x in
    the turning frame. Blades meet the casing when it exceeds the clearance, since each tip passes the smallest gap.
    """
    system = reduce(machine, Reduction()).at_speed(rad_per_s(speed_rpm))
    q = np.linalg.solve(system.K, system.force)
    u = system.tip_static + q[: system.centre].reshape(-1, 3)
    return float(np.hypot(system.tip_radius + u[:, 0], u[:, 1]).max()) - system.tip_radius


def fit_unbalance_and_clearance(machine: Machine, surface: Surface = "smooth") -> tuple[float, float]:
    """Unbalance in kg m and clearance in m that put onset and end of rubbing where the paper has them.

    The tips just touch at 6,720 rev/min, and 1 um of air is left at 10,000 rev/min and 6.75e8 N/m. The clearance is the
    smallest gap of the smooth curve at rest. So with the surface "chords" it is larger by `chord_inset`, and the tips
    have the same air. The unbalance does not depend on the surface.
    """
    stiff = replace(machine, disk_support=replace(machine.disk_support, lateral_stiffness_n_per_m=END_OF_RUB_STIFFNESS))

    def mismatch(unbalance: float) -> float:
        onset = tip_growth(replace(machine, unbalance_kg_m=unbalance), ONSET_RPM)
        return onset - tip_growth(replace(stiff, unbalance_kg_m=unbalance), END_OF_RUB_RPM) - AIR_AT_END_OF_RUB

    unbalance = float(brentq(mismatch, 1e-4, 1.0, xtol=1e-9))
    growth = tip_growth(replace(machine, unbalance_kg_m=unbalance), ONSET_RPM)
    return unbalance, growth if surface == "smooth" else matched_clearance(machine, growth)


def matched_clearance(machine: Machine, air: float) -> float:
    """The clearance in m with which chords leave the tips `air` (m) at rest: `air` plus `chord_inset` at it."""
    clearance = air
    for _ in range(3):  # the inset grows by 1.5e-4 of the clearance
        clearance = air + chord_inset(replace(machine, casing=replace(machine.casing, clearance_m=clearance)))
    return clearance


def chord_inset(machine: Machine) -> float:
    """How far the narrowest place of the chords between the casing's nodes lies inside that of the smooth curve, in m.

    The distance of the straight line between two nodes from the centre is |P x P'| / |P' - P|, from plane geometry; it
    is the least distance of the chord where its foot lies between the nodes. Nodes stand at equal polar angles.
    """
    casing, angle = machine.casing, 2 * np.pi * np.arange(machine.casing.nodes) / machine.casing.nodes
    radius = machine.casing_mean_radius_m - casing.ovality_m / 2 * np.cos(casing.lobes * angle)
    start = radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    along = np.roll(start, -1, axis=0) - start
    share = np.clip(-np.sum(start * along, axis=1) / np.sum(along**2, axis=1), 0, 1)
    nearest = np.hypot(*(start + share[:, None] * along).T)
    return float(machine.casing_mean_radius_m - casing.ovality_m / 2 - nearest.min())
