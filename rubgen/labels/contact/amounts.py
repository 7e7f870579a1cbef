"""Measure how much the blades touch: counts, friction work, each blade's share, severity, extent."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from rubgen.arrays import FloatArray, IntArray
from rubgen.brief import brief
from rubgen.labels.contact.zones import ContactZones
from rubgen.solver.response import Response
from rubgen.units import STANDARD_GRAVITY

LASTING = 0.95
"""Contact in at least this share of the time counts as permanent."""


class RubExtent(StrEnum):
    """How far around the casing a rub extends, and whether it is permanent."""

    NONE = "none"
    PARTIAL = "partial"
    FULL_ANNULAR = "full-annular"


@dataclass(frozen=True, kw_only=True)
class ContactAmounts:
    """Counts and works of contact over the record."""

    touches: int
    """Number of touches of all blades."""
    friction_work: float
    """Work of friction between blisk and casing, J a turn, <= 0."""
    blade_touches: IntArray
    """Number of touches of each blade (n_blades,)."""
    blade_impulses: FloatArray
    """Impulse of each blade (n_blades,), N s a turn."""
    severity: float | None
    """Mean normal force over the weight of the blisk; None where its mass is not known."""
    free_penetration: float | None
    """How deep the rub-free motion would enter the casing, m; None where it is not known."""
    extent: RubExtent
    """How far around the casing the rub extends."""
    __repr__ = brief


def contact_amounts(response: Response, zones: ContactZones, *, record_steps: int) -> ContactAmounts:
    """Compute the amounts of contact of a record.

    severity = sum of the normal impulses of all blades / (m g T), with m the mass of the blisk, g = 9.80665 m/s2 and T
    the duration of the record. It is the mean normal force on the casing over the weight of the blisk.

    - response: the response of the run.
    - zones: the arcs of the casing that blades touch.
    - record_steps: number of time steps of the record, above 0.

    Without contact the counts, impulses and severity are 0. A severity or free penetration that is not known is None.
    """
    events, turns, blades = response.events, response.record_turns, response.n_blades
    weight_time = response.blisk_mass * STANDARD_GRAVITY * record_steps * response.dt
    severity = float(response.impulse_per_turn.sum()) / weight_time
    impulses = np.bincount(events.blade, weights=events.impulse, minlength=blades) / turns
    return ContactAmounts(
        touches=int(events.blade.size),
        friction_work=float(events.friction_loss.sum()) / turns,
        blade_touches=np.bincount(events.blade, minlength=blades).astype(np.int64),
        blade_impulses=np.asarray(impulses, dtype=np.float64),
        severity=severity if np.isfinite(severity) else None,
        free_penetration=response.free_penetration if np.isfinite(response.free_penetration) else None,
        extent=rub_extent(int(response.contact_steps_per_turn.sum()) / record_steps, zones),
    )


def rub_extent(duty: float, zones: ContactZones) -> RubExtent:
    """Classify how far around the casing a rub extends: none, partial or full annular.

    `duty` is the share of the time with contact, 0 to 1, `zones` the contact zones of the record. A rub is full annular
    if `duty` is at least LASTING and the single zone is the whole circle (Muszynska 2005, Rotordynamics, ch. 5). There
    is none if `duty` is 0.
    """
    if duty == 0:
        return RubExtent.NONE
    round_about = len(zones.widths) == 1 and zones.widths[0] >= 2 * np.pi - 1e-9
    return RubExtent.FULL_ANNULAR if duty >= LASTING and round_about else RubExtent.PARTIAL
