"""The class of motion while something drifts, on motions that are written down."""

import numpy as np
import pytest

from rubgen.labels.labels import Motion
from rubgen.labels.motion.chaos import CHAOTIC_FROM, growth_correlation
from rubgen.labels.motion.drifting import (
    MOST_BRANCHES,
    UNPREDICTABLE,
    drifting_motion,
    off_branches,
    prediction_error,
)

TURNS = 96
CENTRE = 108
"""Place of the disk centre's x among the coordinates of the blisk."""


def logistic(turns, rates=4.0):
    values = np.empty(turns)
    values[0] = 0.3
    rates = np.broadcast_to(rates, turns)
    for turn in range(1, turns):
        values[turn] = rates[turn] * values[turn - 1] * (1 - values[turn - 1])
    return values


def moved(respond, values, *, turns=TURNS, contact=True):
    """A response whose orbit grows by a third, with `values` in units of it added to x of the disk centre."""
    drift = np.linspace(0, 1, turns) ** 2 / 3
    blisk = np.zeros((turns, 114))
    blisk[:, CENTRE] = 3e-4 * (drift + values)
    return respond(turns=turns, blisk=blisk, casing=np.zeros((turns, 11)), contact=contact)


def classes_of(response, *, rub=True):
    found = drifting_motion(response, 40, 56, rub=rub)
    return found.system.motion, found.system.period


@pytest.mark.parametrize("period", range(1, MOST_BRANCHES + 1))
def test_points_on_smooth_branches_repeat_however_far_they_drift(respond, period):
    branches = np.array([0.0, 0.3, -0.2, 0.1])[np.arange(TURNS) % period]
    motion = Motion.PERIOD_1 if period == 1 else Motion.PERIOD_K
    assert classes_of(moved(respond, branches)) == (motion, period)


@pytest.mark.parametrize("rates", [4.0, np.linspace(3.9, 4.0, TURNS)])
def test_points_that_scatter_and_cannot_be_predicted_are_chaos(respond, rates):
    assert classes_of(moved(respond, logistic(TURNS, rates))) == (Motion.CHAOTIC, None)


@pytest.mark.parametrize("decay", [0.0, 0.03])
@pytest.mark.parametrize("chirp", [0.0, 0.3])
@pytest.mark.parametrize("frequency", [0.4, 1.1, 1.7, 2.6])  # no slow beat with 1 to 4 turns
def test_a_torus_or_a_motion_that_settles_is_neither(respond, frequency, chirp, decay):
    turn = np.arange(TURNS)
    angle = frequency * turn + chirp * turn**2 / 2 / TURNS
    values = 0.5 * np.exp(-decay * turn) * np.cos(angle)
    assert classes_of(moved(respond, values)) == (Motion.UNDECIDED, None)


def test_scatter_below_the_scale_of_the_motion_is_no_chaos(respond):
    small = logistic(TURNS) - 0.5
    assert classes_of(moved(respond, 0.01 * small)) == (Motion.PERIOD_1, 1)
    assert classes_of(moved(respond, 0.08 * small)) == (Motion.UNDECIDED, None)


def test_a_jump_within_the_turns_is_undecided(respond):
    assert classes_of(moved(respond, np.where(np.arange(TURNS) < 48, 0.0, 0.3))) == (Motion.UNDECIDED, None)


def test_a_class_needs_32_turns_and_chaos_64(respond):
    for turns, motion in ((31, Motion.UNDECIDED), (63, Motion.UNDECIDED), (64, Motion.CHAOTIC)):
        response = moved(respond, logistic(turns), turns=turns)
        assert drifting_motion(response, 0, 16, rub=True).system.motion is motion
    short = moved(respond, np.zeros(32), turns=32)
    assert drifting_motion(short, 0, 16, rub=True).system.motion is Motion.PERIOD_1


def test_without_rub_the_motion_is_the_forced_one(respond):
    scattered = moved(respond, logistic(TURNS), contact=False)
    assert classes_of(scattered, rub=False) == (Motion.PERIOD_1, 1)


def test_a_casing_that_scatters_makes_the_whole_chaotic(respond):
    casing = np.zeros((TURNS, 11))
    casing[:, 0] = 1e-4 * logistic(TURNS)
    found = drifting_motion(respond(turns=TURNS, casing=casing), 40, 56, rub=True)
    assert (found.blisk.motion, found.casing.motion) == (Motion.PERIOD_1, Motion.CHAOTIC)
    assert found.system.motion is Motion.CHAOTIC


def test_the_0_1_test_cannot_tell_a_torus_from_chaos_in_64_turns():
    """Why the class of a drifting motion does not use it."""
    tori = [np.cos(0.31 + frequency * np.arange(64)) for frequency in np.linspace(0.35, 2.75, 40)]
    called = [growth_correlation(torus) > CHAOTIC_FROM for torus in tori]
    assert 0.3 < np.mean(called) < 0.7
    assert max(prediction_error(torus) for torus in tori) < 1e-9


def test_branches_are_fitted_exactly_where_they_are_quadratic():
    time = np.linspace(0, 1, 32)[:, None, None]
    points = np.where((np.arange(32) % 2 == 0)[:, None, None], 1 + time**2, 3 * time - time**2) * np.ones((1, 3, 4))
    assert np.abs(off_branches(points, 2)).max() < 1e-12
    assert np.abs(off_branches(points, 1)).max() > 0.1


def test_what_few_frequencies_make_is_predicted_and_what_is_drawn_is_not():
    turn, rng = np.arange(64), np.random.default_rng(5)
    regular = np.exp(-turn / 30) * np.cos(1.3 * turn + 1) + 0.4 * np.cos(2.2 * turn)
    assert prediction_error(regular) < 1e-9
    errors = [prediction_error(rng.normal(size=64)) for _ in range(40)]
    assert np.mean(errors) == pytest.approx(1.0, abs=0.05)
    assert min(errors) > UNPREDICTABLE
    assert prediction_error(logistic(64)) > UNPREDICTABLE
    assert prediction_error(np.full(64, 2.0)) == 0.0
