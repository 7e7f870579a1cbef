import numpy as np
import pytest
from scipy.integrate import quad

from rubgen.scenario import Operation
from rubgen.scenario.checks.profiles import profile_problem
from rubgen.scenario.rotation import Rotation, steady_rotation

ROTATIONS = [
    Rotation(start=600.0, end=900.0, seconds=0.4),
    Rotation(start=900.0, end=20.0, seconds=2.0),
    Rotation(start=700.0, end=700.0, swing=30.0, period=0.13),
    Rotation(start=600.0, end=900.0, seconds=0.4, swing=-50.0, period=0.07),
    steady_rotation(500.0),
]
STEADY_HAS_NONE = 'the profile "steady" has none; leave it out or give the profile "run-up" or "coast-down"'


@pytest.mark.parametrize("rotation", ROTATIONS)
def test_the_angle_is_the_integral_of_the_speed_and_this_that_of_the_acceleration(rotation):
    corners = [0.0, rotation.seconds]
    for time in (-0.31, 0.17, 0.9, 2.7):
        within = [t for t in corners if min(time, 0) < t < max(time, 0)]
        angle = quad(rotation.speed, 0, time, points=within or None, epsabs=1e-10, limit=500)[0]
        gained = quad(rotation.acceleration, 0, time, points=within or None, epsabs=1e-9, limit=500)[0]
        assert float(rotation.angle(np.array(time))) == pytest.approx(angle, rel=1e-9)
        assert float(rotation.speed(np.array(time))) == pytest.approx(rotation.start + gained, rel=1e-9)


@pytest.mark.parametrize("rotation", ROTATIONS)
def test_the_time_of_an_angle_is_when_it_is_reached(rotation):
    for turn in (-40, -1, 0, 1, 37, 300):
        time = rotation.time_of(2 * np.pi * turn)
        assert float(rotation.angle(np.array(time))) == pytest.approx(2 * np.pi * turn, abs=1e-9)
    assert rotation.slowest <= rotation.speed(np.linspace(-1, 3, 999)).min()
    assert rotation.fastest >= rotation.speed(np.linspace(-1, 3, 999)).max()


def test_a_record_lasts_to_the_end_of_the_turn_in_which_the_duration_ends():
    operation = Operation(profile="run-up", speed_rpm=6000, end_speed_rpm=9000, duration_s=0.201)
    # 0.201 s at 125 turns/s on average are 25.125 turns.
    assert operation.recorded_turns == 26
    even = Operation(profile="coast-down", speed_rpm=9000, end_speed_rpm=6000, duration_s=0.2)
    assert even.recorded_turns == 25
    assert Operation(speed_rpm=6000, record_turns=77).recorded_turns == 77


BAD = [
    ({"profile": "run-up", "duration_s": 1.0}, 'end_speed_rpm: the profile "run-up" needs it; add it'),
    ({"profile": "coast-down", "end_speed_rpm": 1e3}, 'duration_s: the profile "coast-down" needs it; add it'),
    (
        {"end_speed_rpm": 1e3},
        f"end_speed_rpm = 1000: {STEADY_HAS_NONE}",
    ),
    (
        {"profile": "run-up", "end_speed_rpm": 5e3, "duration_s": 1.0},
        "end_speed_rpm = 5000: a run-up ends above its start, speed_rpm = 6000; raise it",
    ),
    (
        {"profile": "coast-down", "end_speed_rpm": 7e3, "duration_s": 1.0},
        "end_speed_rpm = 7000: a coast-down ends below its start, speed_rpm = 6000; lower it",
    ),
    ({"profile": "fluctuating", "duration_s": 1.0}, 'fluctuation_rpm: the profile "fluctuating" needs it; add it'),
    (
        {"profile": "fluctuating", "duration_s": 1.0, "fluctuation_rpm": 6e3},
        "fluctuation_rpm = 6000: must be below speed_rpm = 6000; lower it",
    ),
]


@pytest.mark.parametrize(("keys", "message"), BAD)
def test_what_does_not_fit_a_profile_is_said(keys, message):
    assert profile_problem(Operation(speed_rpm=6000, **keys)) == message


def test_what_fits_is_no_problem():
    for keys in (
        {},
        {"profile": "run-up", "end_speed_rpm": 7e3, "duration_s": 1.0},
        {"profile": "fluctuating", "fluctuation_rpm": 7.0, "duration_s": 1.0},
    ):
        assert profile_problem(Operation(speed_rpm=6000, **keys)) is None
