"""What is kept of a response so that its labels can be made again: section, touches, growths of the twin.

Every label but those of orders is computed from these numbers as they are kept, most in single precision, so that
whoever reads them back finds the same values.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray
from rubgen.scenario.rotation import Rotation
from rubgen.solver.response import ORDERS, ChangingSpeed, ContactEvents, EnergyBalance, Response, Status

CompactRecord = Mapping[str, npt.NDArray[Any]]

TOUCHES = {
    "blade": np.int16,
    "start_step": np.int32,
    "steps": np.int32,
    "angle": np.float32,
    "impulse": np.float32,
    "friction_loss": np.float32,
    "normal_loss": np.float32,
}
"""One number of each for every touch."""
SCALARS = (
    "speed", "dt", "steps_per_turn", "settle_turns", "record_turns", "n_blades", "n_casing", "blisk_mass",
    "free_penetration",
)  # fmt: skip
ROTATION = ("start", "end", "seconds", "swing", "period")


def compact_record(response: Response) -> dict[str, npt.NDArray[Any]]:
    """The arrays to keep of a response: about 0.27 MB for 500 turns and 36 blades, and 26 bytes for each touch.

    `section` (turns, 3 blades + 4 + 2 casing modes): displacements of the tips, x, y, v_x, v_y of the disk centre,
    casing displacements and velocities; `fractions` the same after each Nth of the last turn; `growth`, `turn_impulse`,
    `contact_steps` once a turn, `orbit` in each of the last 100 or, of a changing speed, of all; what `TOUCHES` names
    once a touch; `scalars` (9,); `rotation` (5,) and `turn_steps` of a changing speed, empty otherwise.
    """
    changing = response.changing_speed
    fractions = response.fractions
    kept: dict[str, npt.NDArray[Any]] = {
        "scalars": np.array([getattr(response, name) for name in SCALARS], dtype=np.float64),
        "section": _narrow(response.section_q, response.section_v, response),
        "fractions": _narrow(fractions[:, 0], fractions[:, 1], response) if fractions.size else np.zeros((0, 0), "f4"),
        "growth": response.twin_growth.astype(np.float32),
        "turn_impulse": response.impulse_per_turn.astype(np.float64),
        "contact_steps": response.contact_steps_per_turn.astype(np.int32),
        "orbit": response.orbit.astype(np.float32),
        "rotation": np.array(
            [getattr(changing.rotation, name) for name in ROTATION] if changing else [], dtype=np.float64
        ),
        "turn_steps": (changing.turn_steps if changing else np.zeros(0)).astype(np.int32),
    }
    return kept | {name: getattr(response.events, name).astype(kind) for name, kind in TOUCHES.items()}


def response_of(kept: CompactRecord) -> Response:
    """The response of these arrays, without blisk modes, taps and their orders, energy, and speeds of tips."""
    scalars = dict(zip(SCALARS, kept["scalars"].tolist(), strict=True))
    blades, casing = int(scalars["n_blades"]), int(scalars["n_casing"])
    q, v = _wide(kept["section"], blades, casing)
    fractions = np.stack(_wide(kept["fractions"], blades, casing), axis=1)
    return Response(
        status=Status.OK,
        reason="",
        speed=scalars["speed"],
        dt=scalars["dt"],
        steps_per_turn=int(scalars["steps_per_turn"]),
        settle_turns=int(scalars["settle_turns"]),
        record_turns=int(scalars["record_turns"]),
        taps={},
        section_q=q,
        section_v=v,
        impulse_per_turn=kept["turn_impulse"].astype(np.float64),
        contact_steps_per_turn=kept["contact_steps"].astype(np.int64),
        events=_touches(kept),
        energy=EnergyBalance(**dict.fromkeys(EnergyBalance.__dataclass_fields__, float("nan"))),
        n_blades=blades,
        n_casing=casing,
        twin_growth=kept["growth"].astype(np.float64),
        fractions=fractions,
        changing_speed=_changing_speed(kept, int(scalars["record_turns"])),
        orbit=kept["orbit"].astype(np.float64),
        blisk_mass=scalars["blisk_mass"],
        free_penetration=scalars["free_penetration"],
    )


def in_record_precision(response: Response) -> Response:
    """The response in the precision of the compact record, with its taps and orders."""
    rounded = response_of(compact_record(response))
    return replace(
        rounded, taps=response.taps, changing_speed=response.changing_speed, window_orders=response.window_orders
    )


def _changing_speed(kept: CompactRecord, turns: int) -> ChangingSpeed | None:
    if not kept["rotation"].size:
        return None
    rotation = Rotation(**dict(zip(ROTATION, kept["rotation"].tolist(), strict=True)))
    orders = np.zeros((turns, 0, ORDERS), dtype=np.complex128)
    return ChangingSpeed(rotation=rotation, turn_steps=kept["turn_steps"].astype(np.int64), orders=orders)


def _touches(kept: CompactRecord) -> ContactEvents:
    return ContactEvents(
        blade=kept["blade"].astype(np.int64),
        start_step=kept["start_step"].astype(np.int64),
        steps=kept["steps"].astype(np.int64),
        angle=kept["angle"].astype(np.float64),
        impulse=kept["impulse"].astype(np.float64),
        friction_loss=kept["friction_loss"].astype(np.float64),
        normal_loss=kept["normal_loss"].astype(np.float64),
    )


def _narrow(q: FloatArray, v: FloatArray, response: Response) -> npt.NDArray[np.float32]:
    centre, casing = 3 * response.n_blades, q.shape[1] - response.n_casing
    parts = [q[:, : centre + 2], v[:, centre : centre + 2], q[:, casing:], v[:, casing:]]
    return np.concatenate(parts, axis=1).astype(np.float32)


def _wide(rows: npt.NDArray[Any], blades: int, casing: int) -> tuple[FloatArray, FloatArray]:
    """Q and v (any, 3 blades + 2 + casing) of kept rows."""
    centre = 3 * blades
    rows = rows.astype(np.float64) if rows.size else np.zeros((0, centre + 4 + 2 * casing))
    q = np.concatenate([rows[:, : centre + 2], rows[:, centre + 4 : centre + 4 + casing]], axis=1)
    v = np.zeros_like(q)
    v[:, centre : centre + 2] = rows[:, centre + 2 : centre + 4]
    v[:, centre + 2 :] = rows[:, centre + 4 + casing :]
    return q, v
