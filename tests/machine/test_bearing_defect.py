"""Blows of a defective rolling bearing: their frequencies, their slip, the load zone, their impulse."""

import numpy as np
import pytest
from scipy.signal import butter, hilbert, sosfiltfilt

from rubgen.errors import RubgenWarning, UserError
from rubgen.machine.faults.bearing_defect import BearingDefect, load_share
from rubgen.machine.frame import Frame, FrameMode
from rubgen.measurement import measure
from rubgen.measurement.frame import FrameMotion
from rubgen.measurement.strikes import force_of
from rubgen.scenario import make_scenario, parse_recipe
from rubgen.scenario.surroundings import Surroundings

SKF_6205 = {"balls": 9, "ball_diameter_m": 7.94e-3, "pitch_diameter_m": 39.04e-3}
TABLE = {"outer": 3.5848, "inner": 5.4152, "ball": 4.7135, "cage": 0.39828}
"""Orders of the SKF 6205-2RS as in the tables of the bearing data centre of Case Western Reserve University."""
SPEED = 2 * np.pi * 30
DT = 1 / 50_000


def defect(place="outer", **values):
    return BearingDefect(place=place, width_m=5e-4, **{**SKF_6205, **values})


def strikes(fault, seconds=4.0, seed=0):
    turned = SPEED * DT * np.arange(round(seconds / DT))
    return turned, fault.strikes(turned, np.full(turned.size, SPEED), np.random.default_rng(seed))


@pytest.mark.parametrize("place", TABLE)
def test_the_orders_of_the_6205_are_those_of_the_table(place):
    assert defect(place).order == pytest.approx(TABLE[place], rel=4e-4)


@pytest.mark.parametrize("place", TABLE)
def test_blows_come_at_their_order_with_the_slip_given(place):
    turned, made = strikes(defect(place, slip=0.02), seconds=20)
    spaces = np.diff(made.turned)
    mean = 2 * np.pi / TABLE[place]
    assert spaces.mean() == pytest.approx(mean, rel=4e-4 + 3 * 0.02 / np.sqrt(spaces.size))
    assert spaces.std() == pytest.approx(0.02 * mean, rel=0.2)
    assert turned[0] <= made.turned[0] < turned[0] + 1.2 * mean
    assert turned[-1] - 1.2 * mean < made.turned[-1] < turned[-1]


def test_a_longer_record_before_changes_no_later_blow():
    short, long = (strikes(defect("inner"), seconds) for seconds in (2.0, 3.0))
    count = short[1].turned.size
    assert long[1].turned[-count:] - long[0][-1] == pytest.approx(short[1].turned - short[0][-1], abs=1e-9)


def test_the_load_zone_is_that_of_stribeck():
    assert load_share(np.array([0, np.pi / 2, np.pi])) == pytest.approx([1, 0, 0])
    assert load_share(np.array([np.pi / 3, -np.pi / 3])) == pytest.approx([0.5**1.5] * 2)


def test_an_outer_race_is_always_struck_under_load_and_an_inner_one_once_a_turn():
    assert strikes(defect("outer"))[1].direction_rad == pytest.approx(np.deg2rad(270))
    for place, order in (("inner", 1.0), ("ball", TABLE["cage"])):
        _, made = strikes(defect(place))
        turning = np.polyfit(made.turned, made.direction_rad, 1)[0]
        assert turning == pytest.approx(order, rel=1e-4)
        assert made.impulse_n_s == pytest.approx(
            load_share(made.direction_rad - np.deg2rad(270)) * defect(place).impulse(np.array([SPEED]))[0]
        )


def test_a_blow_turns_the_velocity_of_the_ball_by_the_angle_of_the_spall():
    """A ball of 2.044 g at 0.4 of the shaft's speed on a radius of 19.52 mm, turned twice by w / d."""
    mass, velocity = 7800 * np.pi / 6 * 7.94e-3**3, 0.39831 * SPEED * 19.52e-3
    expected = 2 * mass * velocity * 0.5 / 7.94
    assert defect().impulse(np.array([SPEED, 2 * SPEED])) == pytest.approx([expected, 2 * expected], rel=1e-4)
    # Balls roll along the inner race as fast as it is ahead of the cage; a ball spins 2.357 times a turn.
    inner, ball = (defect(place).impulse(np.array([SPEED]))[0] for place in ("inner", "ball"))
    assert inner == pytest.approx(expected * 0.60169 / 0.39831, rel=1e-4)
    assert ball == pytest.approx(expected * 2.3567 * 3.97 / (0.39831 * 19.52), rel=1e-3)


def test_the_force_of_blows_has_their_impulse_and_their_time():
    turned, made = strikes(defect("inner"), seconds=0.5)
    x, y = force_of(made, turned, DT)
    for force, along in ((x, np.cos(made.direction_rad)), (y, np.sin(made.direction_rad))):
        assert DT * force.sum() == pytest.approx((made.impulse_n_s * along).sum(), rel=1e-9)
        first_moment = (made.impulse_n_s * along * made.turned).sum()
        assert DT * (force * turned).sum() == pytest.approx(first_moment, rel=1e-9)


def envelope_spectrum(signal):
    """Orders, and the amplitude of the envelope between 3 and 5 kHz at each."""
    band = sosfiltfilt(butter(4, (3000, 5000), btype="band", fs=1 / DT, output="sos"), signal)
    envelope = np.abs(hilbert(band))
    spectrum = np.abs(np.fft.rfft((envelope - envelope.mean()) * np.hanning(envelope.size)))
    return np.fft.rfftfreq(envelope.size, DT) / 30, spectrum


@pytest.mark.parametrize("place", TABLE)
def test_the_envelope_of_the_housing_has_its_line_at_the_order_of_the_table(place):
    frame = Frame(modes=(FrameMode(frequency_hz=4000, damping=0.05, modal_mass_kg=10, direction_deg=250),))
    turned, made = strikes(defect(place, slip=0.002), seconds=6)
    silence = np.random.default_rng(1).normal(0, 0.002, turned.size)
    shaken = FrameMotion(frame=frame, force=force_of(made, turned, DT), dt=DT).of_housing(270) + silence
    order, spectrum = envelope_spectrum(shaken)
    near = np.abs(order - TABLE[place]) < 0.03
    floor = np.median(spectrum[(order > 0.2) & (order < 8)])
    assert spectrum[near].max() > 8 * floor
    sides = {"inner": 1.0, "ball": TABLE["cage"]}.get(place)
    if sides:
        for side in (-sides, sides):
            assert spectrum[np.abs(order - TABLE[place] - side) < 0.03].max() > 6 * floor


def test_a_defect_reaches_housing_and_path_and_moves_no_other_channel(make_synthetic_run):
    run = make_synthetic_run(sensors="field")

    def channels(*faults, **surroundings):
        around = Surroundings(**surroundings) if surroundings else None
        return measure(
            run.response, run.scenario.sensing, seconds=0.2, rng=np.random.default_rng(0), surroundings=around,
            frame=run.scenario.machine.frame, faults=faults,
        ).channels  # fmt: skip

    def changed(**surroundings):
        sound, bad = channels(**surroundings), channels(BearingDefect(width_m=2e-3), **surroundings)
        return {name for name in sound if not np.array_equal(sound[name].values, bad[name].values)}

    assert changed() == {"housing_acc_x", "housing_acc_y"}
    assert changed(path_gain=1) == {"housing_acc_x", "housing_acc_y", "casing_acc_45", "casing_acc_135"}


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"balls": 30}, "ball_diameter_m = 0.022: 30 balls on pitch_diameter_m = 0.115 have room for 0.01202 m each"),
        ({"width_m": 0.05}, "width_m = 0.05: wider than a ball, 0.022 m; lower it"),
        ({"place": "race"}, "place"),
    ],
)
def test_a_bearing_that_cannot_be_is_refused(values, words):
    with pytest.raises(UserError) as caught:
        make_scenario(fault="bearing-defect", sensors="field", **{"width_m": 1e-3, **values})
    assert words in str(caught.value)


def test_a_defect_that_no_sensor_feels_is_warned_of():
    with pytest.warns(RubgenWarning, match="faults.bearing-defect: changes no channel: without path_gain or"):
        make_scenario(fault="bearing-defect", width_m=1e-3)


@pytest.mark.filterwarnings("error")
def test_a_recipe_whose_sensors_feel_it_is_not_warned_of():
    fault = {"kind": "bearing-defect", "share": 0.5, "width_m": {"log_uniform": [1e-4, 1e-3]}}
    base = {"name": "b", "runs": 8, "machine": "zeng2019", "faults": [fault]}
    made = parse_recipe({**base, "surroundings": {"path_gain": 1}})
    having = [bool(made.scenario(index).machine.faults) for index in range(20)]
    assert {True, False} == set(having)
    assert all(made.scenario(index).frame for index in range(20))
