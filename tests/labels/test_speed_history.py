"""Labels over time, from made-up signals and touches whose answer is known."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from rubgen.labels import label
from rubgen.labels.compact_record import compact_record
from rubgen.labels.labels import Motion
from rubgen.labels.speed_history import by_angle, speed_history
from rubgen.labels.to_json import labels_to_json, remade_labels, window_labels
from rubgen.labels.windows import windows
from rubgen.scenario.rotation import Rotation
from rubgen.solver.observers.orders import turn_orders
from rubgen.solver.response import ChangingSpeed
from rubgen.units import rev_per_min

TURNS, STEPS = 80, 256
ROTATION = Rotation(start=800.0, end=1200.0, seconds=0.502)


@pytest.fixture
def ramp(respond, events):
    """Touches from turn 30 to 49, one a turn at theta = 1 rad; order 2 of 5 m/s2 in the casing's acceleration."""
    dt = 2 * np.pi / 1200 / STEPS
    edges = [round(ROTATION.time_of(2 * np.pi * k) / dt) for k in range(TURNS + 1)]
    times = np.array([ROTATION.time_of(2 * np.pi * k + 1.0) for k in range(30, 50)])
    touches = events(np.full(20, 1.0), np.full(20, 0.5), np.full(20, 3), np.rint(times / dt), blades=1)
    orders = []
    for first, last in pairwise(edges):
        theta = ROTATION.angle(np.arange(first, last + 1) * dt)
        orders.append(turn_orders(np.stack([5 * np.cos(2 * theta[:-1] + 0.3)]), theta))
    impulse, contact = np.zeros(TURNS), np.zeros(TURNS, np.int64)
    impulse[30:50], contact[30:50] = 0.5, 3
    response = respond(turns=TURNS, steps=STEPS, touches=touches)
    return replace(
        response,
        dt=dt,
        impulse_per_turn=impulse,
        contact_steps_per_turn=contact,
        changing_speed=ChangingSpeed(rotation=ROTATION, turn_steps=np.array(edges), orders=np.array(orders)),
    )


def test_rub_begins_with_its_first_touch_and_ends_after_its_last(ramp):
    found = speed_history(ramp)
    assert [change.rub for change in found.changes] == [False, True, False]
    on, off = found.changes[1:]
    assert on.time == pytest.approx(ROTATION.time_of(2 * np.pi * 30 + 1), abs=ramp.dt)
    assert off.time == pytest.approx(ROTATION.time_of(2 * np.pi * 49 + 1) + 3 * ramp.dt, abs=2 * ramp.dt)
    assert found.onset_speed == pytest.approx(float(ROTATION.speed(on.time)), rel=1e-9)
    assert found.end_of_rub_speed == pytest.approx(float(ROTATION.speed(off.time)), rel=1e-6)
    assert on.motion is Motion.PERIOD_1  # its section repeats
    assert found.changes[0].motion is Motion.PERIOD_1


def test_a_rub_within_the_first_window_does_not_begin_before_its_first_touch(ramp):
    shifted = replace(
        ramp.events,
        start_step=ramp.events.start_step - ramp.changing_speed.turn_steps[30] + ramp.changing_speed.turn_steps[5],
    )
    contact = np.roll(ramp.contact_steps_per_turn, -25)
    found = speed_history(replace(ramp, events=shifted, contact_steps_per_turn=contact)).changes
    assert [change.rub for change in found] == [False, True, False]
    assert found[1].time == pytest.approx(shifted.start_step[0] * ramp.dt)


def test_windows_tell_speed_impulse_and_orders(ramp):
    found = label(ramp).windows
    assert len(found.start) == 5
    assert found.start[1] == pytest.approx(ROTATION.time_of(2 * np.pi * 16))
    assert np.all(np.diff(found.speed) > 0)
    # Turns 30 and 31 of the second window rub, all of the third, 48 and 49 of the fourth.
    np.testing.assert_allclose(found.impulse, [0, 2 * 0.5 / 16, 0.5, 2 * 0.5 / 16, 0])
    counts = np.diff(ramp.changing_speed.turn_steps[[0, 16, 32, 48, 64, 80]])
    np.testing.assert_allclose(found.duty, [0, 6, 48, 6, 0] / counts)
    np.testing.assert_allclose(found.orders["casing_acc_0"][:, 1], 5.0, rtol=0.02)
    assert found.orders["casing_acc_0"][:, [0, 2, 3]].max() < 0.1


def test_the_scatter_of_a_window_is_the_standard_error_of_its_mean(ramp):
    """Of noise whose |x|^2 has the mean 2 about a steady 5: sqrt(2 / 16), whatever the 5 is."""
    rng = np.random.default_rng(3)
    noise = rng.normal(size=(TURNS, 1, 20)) + 1j * rng.normal(size=(TURNS, 1, 20))
    found = windows(replace(ramp, changing_speed=replace(ramp.changing_speed, orders=5.0 + noise)))
    rms = np.sqrt(np.mean(found.scatter["casing_acc_0"] ** 2))
    assert rms == pytest.approx(np.sqrt(2 / 16), rel=0.06)
    away = found.orders["casing_acc_0"] - 5.0  # of a mean far from zero: the error along it, half of both
    assert np.sqrt(2) * np.sqrt(np.mean(away**2)) == pytest.approx(rms, rel=0.2)


def test_touches_by_angle_have_one_spacing_a_turn(ramp):
    events = by_angle(ramp)
    np.testing.assert_allclose(np.diff(events.start_step), STEPS, atol=1.5)


def test_the_labels_of_the_record_hold_its_course(ramp):
    labels = label(ramp)
    assert labels.motion is Motion.UNDECIDED
    assert labels.contact_duty == pytest.approx(60 / ramp.changing_speed.turn_steps[-1])
    assert 2 in labels.orders_present
    plain = labels_to_json(labels)
    assert plain["change_rub"] == [0, 1, 0]
    assert plain["onset_speed_rpm"] == pytest.approx(rev_per_min(labels.history.onset_speed))
    assert plain["window_rub"] == [0, 1, 1, 1, 0]
    amplitudes = np.reshape(window_labels(labels)["casing_acc_0_window_amplitudes"], (5, 20))
    np.testing.assert_allclose(amplitudes, labels.windows.orders["casing_acc_0"], rtol=1e-7)


def test_labels_over_time_are_made_again_from_what_is_kept(ramp):
    plain, again = labels_to_json(label(ramp)), remade_labels(compact_record(ramp))
    assert again["change_rub"] == [0, 1, 0]
    assert len(again["window_starts_s"]) == 5
    assert {name: plain[name] for name in again} == again


def test_a_rub_that_repeats_has_its_class_however_fast_the_speed_changes(respond):
    """An orbit that follows the speed, whatever its swing: period-1; with a jump in it: undecided about the jump."""
    rotation = Rotation(start=400.0, end=400.0, swing=20.0, period=0.5)
    for jump, expected in ((0.0, {Motion.PERIOD_1}), (1e-4, {Motion.PERIOD_1, Motion.UNDECIDED})):
        blisk = np.zeros((128, 114))
        blisk[:, 108] = 2e-5 * np.cos(np.arange(128) / 12) + jump * (np.arange(128) >= 60)
        response = respond(turns=128, steps=STEPS, blisk=blisk)
        changing = ChangingSpeed(
            rotation=rotation,
            turn_steps=np.array([round(rotation.time_of(2 * np.pi * k) / response.dt) for k in range(129)]),
            orders=np.zeros((128, 1, 20), complex),
        )
        found = label(replace(response, changing_speed=changing))
        assert {change.motion for change in found.history.changes} == expected
        assert {motion for motion, _ in found.windows.motion} == expected
        assert found.motion is Motion.UNDECIDED  # of the whole record


def test_windows_have_classes_while_a_fault_grows(respond):
    """At a steady speed: before the rub the forced motion, then a rub that repeats, then one that does not."""
    turns, rng = 160, np.random.default_rng(2)
    blisk = np.zeros((turns, 114))
    blisk[:, 108] = 1e-6 * np.arange(turns)
    blisk[80:, 108] += 1e-4 * rng.normal(size=80)
    contact = np.full(turns, 20, dtype=np.int64)
    contact[:16] = 0
    found = label(replace(respond(turns=turns, blisk=blisk), contact_steps_per_turn=contact, grows=True))
    motions = [motion for motion, _ in found.windows.motion]
    assert motions[:4] == [Motion.PERIOD_1] * 4
    assert motions[-3:] == [Motion.CHAOTIC] * 3
    assert all(sure is None for _, sure in found.windows.motion)
    assert found.motion is Motion.UNDECIDED
    assert found.history is None
