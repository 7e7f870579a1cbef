"""Figures over a swept parameter: points, bars and shades are those of the runs."""

import numpy as np
import pytest
from matplotlib.colors import to_hex

from rubgen.labels.labels import Motion
from rubgen.viz.colors import MOTION_COLORS
from rubgen.viz.figures.sweeps import DECIBELS, bifurcation, exponent_sweep, spectrum_cascade

SPEEDS = np.array([7000.0, 9000.0, 8000.0])
MOTIONS = ["period-1", "chaotic", "period-k"]


def test_each_run_is_a_column_of_its_section_in_the_colour_of_its_motion():
    sections = [np.full(5, 2.0), np.array([-1.0, 3.0, 0.5]), np.tile([1.0, -1.0], 2)]
    axes = bifurcation(SPEEDS, sections, MOTIONS, x="Speed, rev/min", y="x, µm").axes[0]
    for line, speed, section, motion in zip(axes.lines, SPEEDS, sections, MOTIONS, strict=True):
        assert set(line.get_xdata()) == {speed}
        np.testing.assert_array_equal(line.get_ydata(), section)
        assert to_hex(line.get_color()) == to_hex(MOTION_COLORS[Motion(motion)])
    assert not axes.patches


def test_noise_of_the_sensor_is_a_band_of_three_times_its_rms():
    figure = bifurcation(SPEEDS, [np.zeros(2)] * 3, MOTIONS, x="x", y="y", noise=0.4)
    low, high = figure.axes[0].patches[0].get_extents().transformed(figure.axes[0].transData.inverted()).intervaly
    assert (low, high) == pytest.approx((-1.2, 1.2))
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    assert words == ["period-1", "period-k", "chaotic", "noise of the sensor, ±3 rms"]


def test_an_exponent_stands_at_its_value_with_its_error():
    axes = exponent_sweep(SPEEDS, np.array([-0.2, 0.3, 0.0]), np.array([0.01, 0.02, 0.05]), MOTIONS, x="x").axes[0]
    bars = [container.lines[2][0].get_segments()[0] for container in axes.containers]
    assert [bar[:, 0].tolist() for bar in bars] == [[speed, speed] for speed in SPEEDS]
    np.testing.assert_allclose([bar[:, 1] for bar in bars], [[-0.21, -0.19], [0.28, 0.32], [-0.05, 0.05]], atol=1e-12)


def shades(figure):
    """Rows of the map from below, and its edges."""
    mesh = figure.axes[0].collections[0]
    return np.asarray(mesh.get_array()), mesh.get_coordinates()


def test_runs_of_a_cascade_ascend_and_their_shades_are_decibels_below_the_largest():
    orders = np.array([0.5, 1.0, 1.5])
    amplitudes = np.array([[1.0, 10.0, 0.1], [100.0, 1e-9, 0.0], [50.0, 5.0, 0.5]])
    found, corners = shades(spectrum_cascade(SPEEDS, orders, amplitudes, y="Speed, rev/min", unit="g"))
    expected = np.array([[-40, -20, -60], [-6.0206, -26.0206, -46.0206], [0, -DECIBELS, -DECIBELS]])
    np.testing.assert_allclose(found.reshape(3, 3), expected, atol=1e-3)
    np.testing.assert_allclose(corners[0, :, 0], [0.25, 0.75, 1.25, 1.75])
    np.testing.assert_allclose(corners[:, 0, 1], [6500, 7500, 8500, 9500])


def test_a_cascade_of_one_silent_run_is_drawn():
    found, corners = shades(spectrum_cascade(np.array([5.0]), np.array([1.0]), np.zeros((1, 1)), y="y", unit="g"))
    assert found.ravel().tolist() == [-DECIBELS]
    assert [corners[:, 0, 1].tolist(), corners[0, :, 0].tolist()] == [[4.5, 5.5], [0.5, 1.5]]
