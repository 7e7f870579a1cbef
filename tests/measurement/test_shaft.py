"""The shaft's angle within a turn."""

from types import SimpleNamespace

import numpy as np
import pytest

from rubgen.measurement.shaft import (
    arrival_times,
    in_turn,
    pulse_channel,
    pulse_times,
    shaft_angle,
    shaft_speed,
)
from rubgen.scenario.rotation import Rotation


def test_an_angle_within_a_turn_is_never_the_whole_turn():
    """A tiny negative angle rounds up to 2 pi, which is 0."""
    angles = np.array([-1e-20, 0.0, 2 * np.pi, -2 * np.pi, -1e-3, 7.0, -700.0])
    turned = in_turn(angles)
    assert np.all((turned >= 0) & (turned < 2 * np.pi))
    np.testing.assert_allclose(np.exp(1j * turned), np.exp(1j * angles), atol=1e-12)
    assert turned[0] == 0.0


RUN_UP = Rotation(start=600.0, end=1100.0, seconds=0.4, swing=15.0, period=0.11)


def run_up(tail_steps=9000, record_steps=12_000, dt=3e-5):
    """What measuring reads of a run whose speed changes."""
    return SimpleNamespace(
        changing_speed=SimpleNamespace(rotation=RUN_UP), dt=dt, tail_steps=tail_steps, record_steps=record_steps
    )


@pytest.mark.parametrize(("start", "seconds"), [(0.0, 0.2), (0.0931, 0.25), (0.3, 0.004)])
def test_pulses_at_a_changing_speed_are_where_the_angle_is_whole_turns(start, seconds):
    angle = RUN_UP.angle(np.array([start, start + seconds]))
    times = pulse_times(run_up(), float(np.mod(angle[0], 2 * np.pi)), start, seconds)
    turns = RUN_UP.angle(times + start) / (2 * np.pi)
    np.testing.assert_allclose(turns, np.rint(turns), atol=1e-9)
    assert np.all(np.diff(np.rint(turns)) == 1)
    first, last = np.ceil(angle[0] / (2 * np.pi) - 1e-12), np.ceil(angle[1] / (2 * np.pi)) - 1
    assert times.size == last - first + 1
    assert times.size == 0 or 0 <= times[0] < times[-1] + 1e-12 < seconds


@pytest.mark.parametrize("first", [0.0, 1e-9, 2.0, 2 * np.pi - 1e-9])
def test_pulses_at_a_steady_speed_are_equally_far_apart_and_inside(first):
    speed, seconds = 700.0, 0.1
    times = arrival_times(first, speed, seconds)
    turns = (first + speed * times) / (2 * np.pi)
    np.testing.assert_allclose(turns, np.arange(times.size) + (0 if first == 0 else 1), atol=1e-12)
    assert times.size == np.floor((first + speed * seconds) / (2 * np.pi)) + (first == 0)
    assert times.min() >= 0
    assert times.max() < seconds
    assert arrival_times(1.0, speed, 1e-3).size == 0


def test_the_angle_is_the_integral_of_the_speed_and_zero_after_the_last_step():
    response, steps = run_up(), np.arange(9000)
    angle, speed = np.unwrap(shaft_angle(response, steps)), shaft_speed(response, steps)
    np.testing.assert_allclose(np.diff(angle) / response.dt, (speed[1:] + speed[:-1]) / 2, rtol=1e-6)
    time = (response.record_steps - response.tail_steps + steps) * response.dt
    np.testing.assert_allclose(speed, RUN_UP.speed(time), rtol=1e-14)
    steady = SimpleNamespace(changing_speed=None, tail_steps=100, steps_per_turn=64, speed=500.0)
    np.testing.assert_allclose(
        shaft_angle(steady, np.array([100, 84, 36, 99.5])), [0, 1.5 * np.pi, 0, 63.5 / 32 * np.pi]
    )
    np.testing.assert_array_equal(shaft_speed(steady, np.arange(3)), 500.0)


def test_the_notch_is_seen_for_a_twelfth_of_a_turn():
    angle = 2 * np.pi / 1200 * (np.arange(2400) + 0.5)
    channel = pulse_channel(angle, "tacho", keep_clean=True)
    assert channel.values.mean() == pytest.approx(1 / 12, abs=1e-3)
    assert np.flatnonzero(np.diff(channel.values) > 0).tolist() == [1199]
    assert channel.values[0] == 1
    np.testing.assert_array_equal(channel.clean, channel.values)
    assert pulse_channel(angle).clean is None
