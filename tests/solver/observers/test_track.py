"""The replay track holds the true motion about the hardest touch."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.scenario import ContactLaw
from rubgen.solver.integrate import integrate
from rubgen.solver.observers.track import TRACK_TURNS
from rubgen.solver.scheme.stepper import FRAMES
from rubgen.solver.wants import Wants

SECONDS = 60.5 * 2 * np.pi / 500.0  # 60 turns


@pytest.fixture(scope="module")
def rub(small_system, operation):
    system = small_system(speed=500.0, unbalance=0.0)
    system.force[[0, 3]] = 40.0, -10.0  # uneven blades
    turned = replace(operation(system), record_turns=80)
    return system, integrate(system, turned, ContactLaw(friction=0.1), Wants(tail_seconds=SECONDS))


def test_the_track_is_eight_whole_turns_of_the_signals(rub):
    _, response = rub
    step = response.track.step
    assert len(step) == TRACK_TURNS * FRAMES
    assert np.all(np.diff(step) == response.steps_per_turn // FRAMES)
    assert step[0] % response.steps_per_turn == 0
    assert step[0] >= 20 * response.steps_per_turn
    assert step[-1] < response.record_turns * response.steps_per_turn


def test_frames_agree_with_the_taps_and_with_the_section(rub):
    system, response = rub
    track, steps = response.track, response.steps_per_turn
    theta = 2 * np.pi * track.step / steps
    x, y = track.q[:, system.centre], track.q[:, system.centre + 1]
    tap = response.taps["blisk_x"][track.step - response.record_turns * steps]
    np.testing.assert_allclose(np.cos(theta) * x - np.sin(theta) * y, tap, rtol=0, atol=1e-12 * np.abs(tap).max())
    at_turns = track.step % steps == 0
    section = response.section_q[track.step[at_turns] // steps]
    np.testing.assert_allclose(track.q[at_turns], section, rtol=0, atol=1e-12 * np.abs(section).max())


def test_the_track_holds_the_hardest_touch_of_the_signals(rub):
    _, response = rub
    events, track = response.events, response.track
    end = events.start_step + events.steps
    within = end > 20 * response.steps_per_turn
    shown = (end > track.step[0]) & (events.start_step <= track.step[-1])
    assert events.impulse[shown].max() == events.impulse[within].max() > 1.001 * np.median(events.impulse[within])


def test_without_signals_nothing_is_kept(small_system, operation):
    system = small_system()
    short = operation(system, record_turns=3, settle_turns=10)
    assert integrate(system, short, ContactLaw()).track is None


def test_fewer_turns_than_a_window_are_all_kept(small_system, operation):
    system = small_system()
    short = operation(system, record_turns=3, settle_turns=10)
    track = integrate(system, short, ContactLaw(), Wants(tail_seconds=3.5 * 2 * np.pi / system.speed)).track
    assert len(track.step) == 3 * FRAMES
    assert track.step[0] == 0
