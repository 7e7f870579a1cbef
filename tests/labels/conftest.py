"""Responses whose labels are known, because their signals were written down rather than integrated."""

from collections.abc import Callable

import numpy as np
import pytest

from rubgen.solver.response import ContactEvents, EnergyBalance, Response, Status

SPEED = 2 * np.pi * 150.0
BLADES, STATES, MODES = 36, 125, 11
ORBIT = 3e-4
"""Radius of the made orbit of the disk centre, in m."""


def made_events(
    angle: np.ndarray, impulse: np.ndarray, steps: np.ndarray, blade: np.ndarray, start: np.ndarray
) -> ContactEvents:
    nothing = np.zeros(angle.size)
    return ContactEvents(
        blade=blade.astype(np.int64),
        start_step=start.astype(np.int64),
        steps=steps.astype(np.int64),
        angle=np.mod(angle, 2 * np.pi),
        impulse=impulse.astype(float),
        friction_loss=nothing,
        normal_loss=nothing,
    )


@pytest.fixture
def events() -> Callable[..., ContactEvents]:
    """Events at angles: 0.1 N s, ten steps, one every 100 steps, five blades where nothing else is said."""

    def make(
        angle: np.ndarray,
        impulse: np.ndarray | None = None,
        steps: np.ndarray | None = None,
        start: np.ndarray | None = None,
        blades: int = 5,
    ) -> ContactEvents:
        impulse = np.full(angle.size, 0.1) if impulse is None else impulse
        steps = np.full(angle.size, 10) if steps is None else steps
        start = 100 * np.arange(angle.size) if start is None else start
        return made_events(angle, impulse, steps, np.arange(angle.size) % blades, start)

    return make


@pytest.fixture
def respond() -> Callable[..., Response]:
    """A response with an orbit of radius 0.3 mm, to which `blisk` (turns, STATES - MODES) and so on are added."""

    def make(
        *,
        turns: int = 500,
        blisk: np.ndarray | None = None,
        casing: np.ndarray | None = None,
        casing_velocity: np.ndarray | None = None,
        contact: bool = True,
        taps: dict[str, np.ndarray] | None = None,
        tail_turns: int = 100,
        steps: int = 256,
        touches: ContactEvents | None = None,
    ) -> Response:
        q, v = np.zeros((turns, STATES)), np.zeros((turns, STATES))
        q[:, 3 * BLADES] = ORBIT
        q[:, : 3 * BLADES : 3] = ORBIT * np.cos(2 * np.pi * np.arange(BLADES) / BLADES)
        if blisk is not None:
            q[:, : STATES - MODES] += blisk
        if casing is not None:
            q[:, -MODES:] = casing
        if casing_velocity is not None:
            v[:, -MODES:] = casing_velocity
        none = np.zeros(0)
        return Response(
            status=Status.OK,
            reason="",
            speed=SPEED,
            dt=2 * np.pi / SPEED / steps,
            steps_per_turn=steps,
            settle_turns=100,
            record_turns=turns,
            taps={"casing_acc_0": np.zeros(tail_turns * steps)} | (taps or {}),
            section_q=q,
            section_v=v,
            impulse_per_turn=np.full(turns, 1.5 if contact else 0.0),
            contact_steps_per_turn=np.full(turns, steps // 4 if contact else 0, dtype=np.int64),
            events=touches or made_events(none, none, none, none, none),
            energy=EnergyBalance(**dict.fromkeys(EnergyBalance.__dataclass_fields__, 0.0)),
            n_blades=BLADES,
            n_casing=MODES,
        )

    return make
