"""The compact record of a response, from which its labels can be made again: section, touches, companion growth.

Every label except the orders is computed from the compact record, most of it in single precision. Labels made from a
record read back from a file are therefore equal.
"""

from collections.abc import Mapping, Sequence
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
    """Return the arrays of a response from which its labels can be computed again.

    They have about 0.27 MB for 500 turns and 36 blades, and 26 bytes a touch.

    - `scalars` (9,): the numbers with the names SCALARS; where a fault grows (`Response.grows`), a tenth number, 1.
    - `section` (turns, 3 blades + 4 + 2 casing modes), once a turn: displacements of the tips, x, y, v_x, v_y of the
      disk centre, displacements and velocities of the casing modes.
    - `fractions` (N, as many): the same values for each of `Response.symmetry_states`.
    - `turn_impulse`, `contact_steps` (turns,): `impulse_per_turn` and `contact_steps_per_turn` of the response.
    - `growth` (any,) and `orbit` (any, 5): `companion_growth` and `orbit`, which may have fewer turns than the record.
    - `rotation` (5,) and `turn_steps` (turns + 1,) of a changing speed; empty for a steady speed.
    - the names of `TOUCHES` (touches,): the fields of `ContactEvents`.
    """
    changing = response.changing_speed
    states = response.symmetry_states
    record: dict[str, npt.NDArray[Any]] = {
        "scalars": np.array(
            [*(getattr(response, name) for name in SCALARS), *([1.0] if response.grows else [])], dtype=np.float64
        ),
        "section": _narrow(response.section_q, response.section_v, response),
        "fractions": _narrow(states[:, 0], states[:, 1], response) if states.size else np.zeros((0, 0), "f4"),
        "growth": response.companion_growth.astype(np.float32),
        "turn_impulse": response.impulse_per_turn.astype(np.float64),
        "contact_steps": response.contact_steps_per_turn.astype(np.int32),
        "orbit": response.orbit.astype(np.float32),
        "rotation": np.array(
            [getattr(changing.rotation, name) for name in ROTATION] if changing else [], dtype=np.float64
        ),
        "turn_steps": (changing.turn_steps if changing else np.zeros(0)).astype(np.int32),
    }
    return record | {name: getattr(response.events, name).astype(kind) for name, kind in TOUCHES.items()}


def response_of(record: CompactRecord) -> Response:
    """Make a response from a compact record.

    Its status is OK. It has no taps, orders, track, arrivals, worn liner and modes of the blisk. The velocities of the
    tips are 0, the energies NaN.
    """
    scalars = named_scalars(record["scalars"].tolist())
    blades, casing = int(scalars["n_blades"]), int(scalars["n_casing"])
    q, v = _wide(record["section"], blades, casing)
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
        impulse_per_turn=record["turn_impulse"].astype(np.float64),
        contact_steps_per_turn=record["contact_steps"].astype(np.int64),
        events=_touches(record),
        energy=EnergyBalance(**dict.fromkeys(EnergyBalance.__dataclass_fields__, float("nan"))),
        n_blades=blades,
        n_casing=casing,
        companion_growth=record["growth"].astype(np.float64),
        symmetry_states=np.stack(_wide(record["fractions"], blades, casing), axis=1),
        changing_speed=_changing_speed(record, int(scalars["record_turns"])),
        orbit=record["orbit"].astype(np.float64),
        blisk_mass=scalars["blisk_mass"],
        free_penetration=scalars["free_penetration"],
        grows="grows" in scalars,
    )


def named_scalars(values: Sequence[float]) -> dict[str, float]:
    """Return the numbers `scalars` of a compact record by name. Raises ValueError for a wrong number of values.

    `grows` is among the names only where the record has a tenth number.
    """
    names = (*SCALARS, "grows") if len(values) == len(SCALARS) + 1 else SCALARS
    return dict(zip(names, values, strict=True))


def in_record_precision(response: Response) -> Response:
    """Round a response to the precision of the compact record. Its taps and orders are not rounded.

    What else the record does not contain is lost as in `response_of`, such as energies and the track. The labels of a
    run are then equal to labels computed from its compact record.
    """
    rounded = response_of(compact_record(response))
    return replace(
        rounded, taps=response.taps, changing_speed=response.changing_speed, window_orders=response.window_orders
    )


def _changing_speed(record: CompactRecord, turns: int) -> ChangingSpeed | None:
    if not record["rotation"].size:
        return None
    rotation = Rotation(**dict(zip(ROTATION, record["rotation"].tolist(), strict=True)))
    orders = np.zeros((turns, 0, ORDERS), dtype=np.complex128)
    return ChangingSpeed(rotation=rotation, turn_steps=record["turn_steps"].astype(np.int64), orders=orders)


def _touches(record: CompactRecord) -> ContactEvents:
    wide = {name: np.int64 if np.issubdtype(kind, np.integer) else np.float64 for name, kind in TOUCHES.items()}
    fields: dict[str, npt.NDArray[Any]] = {name: record[name].astype(kind) for name, kind in wide.items()}
    return ContactEvents(**fields)


def _narrow(q: FloatArray, v: FloatArray, response: Response) -> npt.NDArray[np.float32]:
    centre, casing = 3 * response.n_blades, q.shape[1] - response.n_casing
    parts = [q[:, : centre + 2], v[:, centre : centre + 2], q[:, casing:], v[:, casing:]]
    return np.concatenate(parts, axis=1).astype(np.float32)


def _wide(rows: npt.NDArray[Any], blades: int, casing: int) -> tuple[FloatArray, FloatArray]:
    """Return q and v (any, 3 blades + 2 + casing) of rows of a record."""
    centre = 3 * blades
    rows = rows.astype(np.float64) if rows.size else np.zeros((0, centre + 4 + 2 * casing))
    q = np.concatenate([rows[:, : centre + 2], rows[:, centre + 4 : centre + 4 + casing]], axis=1)
    v = np.zeros_like(q)
    v[:, centre : centre + 2] = rows[:, centre + 2 : centre + 4]
    v[:, centre + 2 :] = rows[:, centre + 4 + casing :]
    return q, v
