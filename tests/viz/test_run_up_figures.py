"""Waterfall and Bode plot of a made orbit: a forward circle whose size is known, and a smaller backward one."""

from types import SimpleNamespace

import numpy as np
import pytest

from rubgen.viz.figures import bode, run_up, waterfall

FORWARD, BACKWARD, LAG = 200.0, 20.0, np.radians(30)
RATE, SECONDS, ONSET = 25600.0, 2.0, 7410.0


@pytest.fixture
def replay(monkeypatch):
    """A run-up from 6,000 to 9,000 rev/min; theta = 2 pi (100 t + 12.5 t^2)."""
    time = np.arange(round(RATE * SECONDS)) / RATE
    theta = 2 * np.pi * (100 * time + 12.5 * time**2)
    orbit = FORWARD * np.exp(1j * (theta - LAG)) + BACKWARD * np.exp(-1j * theta)
    monkeypatch.setattr(run_up, "shaft_orbit", lambda _: np.array([orbit.real, orbit.imag]))
    turns = np.arange(int(theta[-1] / (2 * np.pi)))
    return SimpleNamespace(
        scenario=SimpleNamespace(operation=SimpleNamespace(profile="run-up")),
        recording=SimpleNamespace(samples=time.size, sample_rate_hz=RATE),
        pulse_times=(-100 + np.sqrt(100**2 + 50 * turns)) / 25,
        labels={"onset_speed_rpm": ONSET},
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


def test_a_steady_run_has_none(replay):
    replay.scenario.operation.profile = "steady"
    with pytest.raises(ValueError, match="steady"):
        waterfall(replay)
