"""The response of a run that never began."""

from __future__ import annotations

import numpy as np

from rubgen.solver.observers.touches import contact_events
from rubgen.solver.response import EnergyBook, Response, Status
from rubgen.taps import DEFAULT_TAPS

NO_ENERGY = EnergyBook(**dict.fromkeys(EnergyBook.__dataclass_fields__, 0.0))


def no_response(
    status: Status,
    reason: str,
    *,
    speed: float,
    dt: float,
    steps_per_turn: int,
    record_turns: int,
    n_blades: int = 0,
    n_casing: int = 0,
    size: int = 0,
) -> Response:
    """A response with a status, its reason, and nothing else; `size` is the number of coordinates."""
    nothing = np.zeros((0, size))
    return Response(
        status=status,
        reason=reason,
        speed=speed,
        dt=dt,
        steps_per_turn=steps_per_turn,
        settle_turns=0,
        record_turns=record_turns,
        taps={tap.name: np.zeros(0) for tap in DEFAULT_TAPS},
        section_q=nothing,
        section_v=nothing,
        impulse_per_turn=np.zeros(0),
        contact_steps_per_turn=np.zeros(0, dtype=np.int64),
        events=contact_events([]),
        energy=NO_ENERGY,
        n_blades=n_blades,
        n_casing=n_casing,
    )
