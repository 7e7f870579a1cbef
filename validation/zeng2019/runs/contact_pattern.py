"""Where and by how many blades the casing is touched in the last turns of a run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.labels.contact.zones import BINS, impulse_histogram
from rubgen.solver.response import ContactEvents, Response

SECTORS = 120
LIGHT = 1e-3
"""Half-degree bins with less than this share of the heaviest one's impulse are not counted as touched."""


@dataclass(frozen=True, kw_only=True)
class ContactPattern:
    """Impulse in N s by sector of the casing (SECTORS,) and by blade, touched arc in degrees.

    `at_once` is the most blades that touch in one step, `neighbours` the share of the steps in contact in which two
    blades side by side touch.
    """

    on_casing: FloatArray
    on_blades: FloatArray
    area_deg: float
    at_once: int
    neighbours: float


def contact_pattern(response: Response, turns: int) -> ContactPattern:
    """The pattern of touches that begin in the last `turns` turns of the record."""
    first = (response.record_turns - turns) * response.steps_per_turn
    events, blades = response.events, response.n_blades
    late = events.start_step >= first
    chosen = ContactEvents(**{name: getattr(events, name)[late] for name in ContactEvents.__dataclass_fields__})
    fine = impulse_histogram(chosen, response.steps_per_turn)
    touching = _touching(chosen, blades, first, turns * response.steps_per_turn)
    count = touching.sum(axis=0)
    pairs = (touching & np.roll(touching, 1, axis=0)).any(axis=0)
    in_contact = int(np.count_nonzero(count))
    return ContactPattern(
        on_casing=fine.reshape(SECTORS, -1).sum(axis=1),
        on_blades=np.bincount(chosen.blade, weights=chosen.impulse, minlength=blades).astype(np.float64),
        area_deg=float(np.count_nonzero(fine > LIGHT * fine.max()) * 360 / BINS) if late.any() else 0.0,
        at_once=int(count.max()),
        neighbours=float(pairs.sum() / in_contact) if in_contact else 0.0,
    )


def _touching(events: ContactEvents, blades: int, first: int, steps: int) -> np.typing.NDArray[np.bool_]:
    """Whether a blade touches, (blades, steps) from step `first`."""
    touching = np.zeros((blades, steps), dtype=np.bool_)
    for blade, start, length in zip(events.blade, events.start_step - first, events.steps, strict=True):
        touching[blade, start : start + length] = True
    return touching
