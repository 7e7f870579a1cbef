from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from rubgen.labels import Motion
from rubgen.labels.motion.classify import motion
from rubgen.labels.motion.section import asymmetry, is_symmetric
from rubgen.solver.response import Response

Respond = Callable[..., Response]


def with_states(response: Response, moved: float, lobes: int = 2) -> Response:
    """The response with the section's last state after each Nth of a turn, the disk centre moved in the first."""
    state = np.stack([response.section_q[-1], response.section_v[-1]])
    states = np.repeat(state[None], lobes, axis=0)
    states[0, 0, 108] += moved * np.abs(state[0, 108])
    return replace(response, symmetry_states=states)


@pytest.fixture
def periodic(respond: Respond) -> Response:
    casing = np.ones((500, 11))
    return respond(casing=casing, casing_velocity=casing)


@pytest.mark.parametrize(("moved", "symmetric"), [(0.0, True), (0.02, True), (0.04, False), (1.0, False)])
def test_states_that_differ_break_the_symmetry(periodic: Response, moved: float, symmetric: bool) -> None:
    response = with_states(periodic, moved)
    assert asymmetry(response) == pytest.approx(moved, abs=1e-9)
    assert is_symmetric(response) is symmetric
    assert motion(response).symmetric is symmetric


def test_only_a_rub_of_period_1_on_lobes_has_a_symmetry(periodic: Response, respond: Respond) -> None:
    assert is_symmetric(periodic) is None
    assert is_symmetric(with_states(periodic, 0.0, lobes=1)) is None
    assert motion(with_states(respond(contact=False), 0.0)).symmetric is None
    swinging = np.array([1.0, 2.0])[np.arange(500) % 2][:, None] * np.ones(11)
    two = with_states(respond(casing=swinging, casing_velocity=swinging), 0.0)
    assert motion(two).system.motion is Motion.PERIOD_K
    assert motion(two).symmetric is None


def test_tips_that_chatter_alone_are_found(respond: Respond) -> None:
    casing, blisk = np.ones((500, 11)), np.zeros((500, 114))
    blisk[:, 3 * 17] = 0.05 * 3e-4 * np.random.default_rng(0).standard_normal(500)
    chattering = motion(respond(blisk=blisk, casing=casing, casing_velocity=casing))
    assert chattering.tip_chatter is True
    assert chattering.casing.motion is Motion.PERIOD_1
    blisk[:, 108] = 0.05 * 3e-4 * np.random.default_rng(1).standard_normal(500)
    assert motion(respond(blisk=blisk, casing=casing, casing_velocity=casing)).tip_chatter is False
