"""Waterfall and Bode plot of a made orbit: a forward circle whose size is known, and a smaller backward one."""

from types import SimpleNamespace

import numpy as np
import pytest

from rubgen import make_scenario
from rubgen.viz.figures import bode, run_up, waterfall

FORWARD, BACKWARD, LAG = 200.0, 20.0, np.radians(30)
RATE, SECONDS, ONSET = 25600.0, 2.0, 7410.0
START, SPEED, SLOPE = 0.1, 5850.0, 1500.0
"""The record begins at SPEED in rev/min, rises by SLOPE a second, and the signals begin START seconds later."""


def touching_from(speed):
    return {"onset_speed_rpm": speed, "change_rub": [False, True], "change_times_s": [0.0, (speed - SPEED) / SLOPE]}


@pytest.fixture
def replay(monkeypatch):
    """A run-up from 6,000 to 9,000 rev/min; theta = 2 pi (100 t + 12.5 t^2)."""
    time = np.arange(round(RATE * SECONDS)) / RATE
    theta = 2 * np.pi * (100 * time + 12.5 * time**2)
    orbit = FORWARD * np.exp(1j * (theta - LAG)) + BACKWARD * np.exp(-1j * theta)
    monkeypatch.setattr(run_up, "shaft_orbit", lambda _: np.array([orbit.real, orbit.imag]))
    turns = np.arange(int(theta[-1] / (2 * np.pi)))
    end = START + SECONDS
    return SimpleNamespace(
        scenario=make_scenario(speed_rpm=SPEED, profile="run-up", end_speed_rpm=SPEED + SLOPE * end, duration_s=end),
        recording=SimpleNamespace(samples=time.size, sample_rate_hz=RATE, start_seconds=START),
        pulse_times=(-100 + np.sqrt(100**2 + 50 * turns)) / 25,
        labels=touching_from(ONSET),
        title="made",
        headline="run-up: rub from 7,410 rev/min",
    )


def test_bode_has_size_and_phase_of_the_forward_whirl_over_the_speed(replay):
    figure = bode(replay)
    speeds, amplitude = figure.axes[0].lines[0].get_xydata().T
    np.testing.assert_allclose(amplitude, FORWARD, rtol=2e-3)
    np.testing.assert_allclose(figure.axes[1].lines[0].get_ydata(), -30, atol=0.2)
    assert (speeds[0], speeds[-1]) == pytest.approx((6000, 9000), rel=0.01)
    assert figure.axes[0].lines[1].get_xdata()[0] == ONSET
    assert "rub from 7,410" in figure.get_suptitle()


def test_waterfall_tells_forward_from_backward(replay):
    figure = waterfall(replay)
    mesh = figure.axes[0].collections[0]
    decibel = np.asarray(mesh.get_array()).mean(axis=0)
    orders = mesh.get_coordinates()[0, :, 0]
    middles = (orders[1:] + orders[:-1]) / 2
    at = {order: decibel[np.argmin(np.abs(middles - order))] for order in (-1, 1, 2)}
    assert at[1] == pytest.approx(0, abs=0.1)
    assert at[-1] == pytest.approx(20 * np.log10(BACKWARD / FORWARD), abs=0.2)
    assert at[2] < -50


@pytest.mark.parametrize("draw", [bode, waterfall])
def test_a_first_touch_before_the_signals_is_said_in_words(replay, draw):
    replay.labels = touching_from(5970.0)  # 0.08 s after the start of the record, 0.02 s before the signals
    text = "The first touch lies before these signals: 0.02 s before they begin, at 5,970 rev/min"
    figure = draw(replay)
    assert figure.axes[0].get_title(loc="left") == text
    assert first_touch_of(figure) is None
    before = np.array([axes.get_xlim() + axes.get_ylim() for axes in figure.axes])
    replay.labels = touching_from(5999.0)
    assert [axes.get_xlim() + axes.get_ylim() for axes in draw(replay).axes] == pytest.approx(before)


@pytest.mark.parametrize("draw", [bode, waterfall])
def test_a_touch_before_the_signals_is_not_marked_where_its_speed_comes_again(replay, draw):
    replay.labels = touching_from(ONSET)
    replay.recording.start_seconds = 1.5  # as after a fluctuation
    figure = draw(replay)
    assert first_touch_of(figure) is None
    assert "before these signals: 0.46 s before" in figure.axes[0].get_title(loc="left")


@pytest.mark.parametrize("draw", [bode, waterfall])
def test_a_first_touch_in_the_first_turn_has_its_own_time(replay, draw):
    replay.labels = {"onset_speed_rpm": 5858.0, "change_rub": [True], "change_times_s": [0.0]}
    assert "0.09 s before they begin, at 5,858" in draw(replay).axes[0].get_title(loc="left")
    replay.recording.start_seconds = 0.004  # and the touch is 0.005 s after the start
    assert "outside of these speeds, at 5,858" in draw(replay, (6000, 7000)).axes[0].get_title(loc="left")


@pytest.mark.parametrize("draw", [bode, waterfall])
def test_a_first_touch_outside_of_the_range_is_said_in_words(replay, draw):
    figure = draw(replay, (7500, 8500))
    assert first_touch_of(figure) is None
    assert figure.axes[0].get_title(loc="left") == "The first touch lies outside of these speeds, at 7,410 rev/min"
    assert first_touch_of(draw(replay, (7000, 8500))) == ONSET
    assert draw(replay).axes[0].get_title(loc="left") == ""


def first_touch_of(figure):
    """Return the speed at which a figure marks the first touch; None where it marks none."""
    drawn = [line for line in figure.axes[0].lines if len(line.get_xdata()) == 2]
    return next((each for line in drawn for each in (*line.get_xdata(), *line.get_ydata()) if each > 1), None)


def test_a_steady_run_has_none(replay):
    replay.scenario = make_scenario()
    with pytest.raises(ValueError, match="steady"):
        waterfall(replay)
