"""The orbit from any pair of proximity probes, in whatever unit they read."""

import dataclasses

import numpy as np
import pytest

from rubgen.viz.derived import poincare_section, shaft_orbit
from rubgen.viz.replay import replay_of


def test_two_probes_along_x_and_y_are_the_orbit_itself(rub_run):
    channels = rub_run.recording.channels
    expected = [1e6 * channels[f"proximity_{axis}"].values.astype(float) for axis in "xy"]
    np.testing.assert_allclose(shaft_orbit(replay_of(rub_run)), expected, rtol=1e-12, atol=1e-9)


def test_gap_voltages_at_45_and_135_degrees_are_turned_back(rig_run):
    """bias + sensitivity u, u = x cos(phi) + y sin(phi)."""
    x, y = shaft_orbit(replay_of(rig_run))
    sensors = {sensor.name: sensor for sensor in rig_run.scenario.sensing.set.sensors}
    for name, angle in (("proximity_45", np.pi / 4), ("proximity_135", 3 * np.pi / 4)):
        reading = sensors[name].bias_v + 1e-6 * sensors[name].sensitivity_v_per_m * (
            x * np.cos(angle) + y * np.sin(angle)
        )
        np.testing.assert_allclose(reading, rig_run.recording.channels[name].values, rtol=1e-6)
    assert np.ptp(x) > 50


def test_a_single_probe_has_no_orbit(rub_run):
    channels = {name: each for name, each in rub_run.recording.channels.items() if name != "proximity_y"}
    one = dataclasses.replace(replay_of(rub_run), recording=dataclasses.replace(rub_run.recording, channels=channels))
    assert shaft_orbit(one) is None
    assert poincare_section(one) is None


def test_the_section_is_the_orbit_at_the_pulses(rub_run):
    replay = replay_of(rub_run)
    found = poincare_section(replay)
    assert found.shape == (2, replay.pulse_times.size)
    sample = replay.pulse_times * replay.recording.sample_rate_hz
    near = shaft_orbit(replay)[:, np.round(sample).astype(int)]
    assert np.abs(found - near).max() == pytest.approx(0, abs=0.1 * np.ptp(found.ravel()) + 5)
