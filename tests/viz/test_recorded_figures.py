"""Figures of a recording alone: what they draw is what was recorded, and empty recordings say so."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.errors import NoPictureError
from rubgen.viz.derived import HIGHEST_ORDER, order_map, shaft_orbit
from rubgen.viz.figures.run import SECTORS, contact_distribution, orbit_section, waveform_orders
from rubgen.viz.replay import replay_of


@pytest.fixture(scope="module")
def replay(rub_run):
    return replay_of(rub_run)


@pytest.fixture(scope="module")
def free(free_run):
    return replay_of(free_run)


def with_recording(replay, **changes):
    return replace(replay, recording=replace(replay.recording, **changes))


def texts(figure):
    return [text.get_text() for axes in figure.axes for text in axes.texts]


def test_each_blade_and_each_sector_has_its_impulse_a_turn(replay):
    figure = contact_distribution(replay)
    polar, bars = figure.axes
    touches, turns = replay.touches, replay.seconds / replay.turn_seconds
    heights = np.array([bar.get_height() for bar in bars.patches])
    expected = [touches.impulse[touches.blade == blade].sum() for blade in range(36)]
    np.testing.assert_allclose(heights, 1e3 * np.array(expected) / turns, rtol=1e-12)
    around = np.array([bar.get_height() for bar in polar.patches])
    assert around.size == SECTORS
    assert around.sum() == pytest.approx(heights.sum(), rel=1e-12)
    turned = np.mod(touches.angle + np.pi / SECTORS, 2 * np.pi)
    first = touches.impulse[turned < 2 * np.pi / SECTORS].sum()
    assert around[0] == pytest.approx(1e3 * first / turns, rel=1e-12)


def test_without_touches_both_panels_say_so(free):
    figure = contact_distribution(free)
    assert texts(figure).count("no contact") == 2
    assert not [bar for bar in figure.axes[1].patches if bar.get_height()]


def test_less_than_a_turn_counts_as_one(replay):
    """The impulse of a recording of a third of a turn is not multiplied by three."""
    few = round(replay.turn_seconds / 3 * replay.recording.sample_rate_hz)
    channels = {name: replace(each, values=each.values[:few]) for name, each in replay.recording.channels.items()}
    short = with_recording(replay, channels=channels)
    heights = [bar.get_height() for bar in contact_distribution(short).axes[1].patches]
    assert sum(heights) == pytest.approx(1e3 * replay.touches.impulse.sum(), rel=1e-12)


def test_the_orbit_has_the_last_thirty_turns_and_a_point_at_each_pulse(replay):
    path, once = orbit_section(replay).axes[0].lines
    x, y = shaft_orbit(replay)
    drawn = path.get_xdata().size / replay.recording.sample_rate_hz / replay.turn_seconds
    assert drawn == pytest.approx(30, abs=0.02)
    np.testing.assert_array_equal(path.get_ydata(), y[-path.get_ydata().size :])
    assert once.get_xdata().size == replay.pulse_times.size
    time = np.arange(x.size) / replay.recording.sample_rate_hz
    assert once.get_xdata()[3] == pytest.approx(np.interp(replay.pulse_times[3], time, x))


def test_without_a_pair_of_probes_there_is_no_orbit(replay):
    channels = {name: each for name, each in replay.recording.channels.items() if name != "proximity_y"}
    with pytest.raises(NoPictureError, match="choose sensors with two"):
        orbit_section(with_recording(replay, channels=channels))


def test_the_waveform_ends_with_the_recording_and_has_a_line_at_each_pulse(replay):
    wave, orders = waveform_orders(replay, "casing_acc_90").axes
    values = replay.recording.channels["casing_acc_90"].values
    (line,) = wave.lines
    drawn = line.get_ydata()
    np.testing.assert_array_equal(drawn, values[-drawn.size :])
    begin = (values.size - drawn.size) / replay.recording.sample_rate_hz
    marks = np.array([segment[0, 0] for segment in wave.collections[0].get_segments()])
    np.testing.assert_allclose(marks / 1e3, replay.pulse_times[replay.pulse_times >= begin] - begin, atol=1e-12)
    (spectrum,) = orders.lines
    found = order_map(values, replay.recording.sample_rate_hz, replay.pulse_times, turns=replay.pulse_times.size)
    at_one = np.flatnonzero(np.isclose(found.order, 1.0))[0]
    assert spectrum.get_ydata()[at_one] == pytest.approx(found.amplitude[0, at_one])
    assert spectrum.get_xdata()[-1] == HIGHEST_ORDER


def test_an_unknown_channel_is_named_with_the_one_that_was_meant(replay):
    with pytest.raises(NoPictureError, match=r"no channel .casing_acc_9.; did you mean casing_acc_90\?"):
        waveform_orders(replay, "casing_acc_9")


@pytest.mark.parametrize("pulses", [np.zeros(0), np.array([0.1])])
def test_without_a_whole_turn_there_is_a_waveform_and_no_spectrum(replay, pulses):
    figure = waveform_orders(with_recording(replay, once_per_rev=pulses))
    assert texts(figure) == ["no whole turn"]
    assert figure.axes[0].lines[0].get_ydata().size > 100


def test_a_spectrum_over_turns_has_the_amplitude_at_each_order():
    """Over five turns of 512 samples: fifths of an order apart, twice the transform over the number of samples."""
    rate, per_turn, turns = 51200.0, 512, 5
    theta = 2 * np.pi / per_turn * np.arange(per_turn * turns + 1)
    values = (1 + 3 * np.cos(theta + 1) + 0.5 * np.sin(2.4 * theta)).astype(np.float32)
    pulses = np.arange(turns + 1) * per_turn / rate
    found = order_map(values, rate, pulses, turns=turns)
    np.testing.assert_allclose(found.order, np.arange(1, 12 * turns + 1) / turns)
    expected = np.zeros(found.order.size)
    expected[turns - 1], expected[12 - 1] = 3, 0.5
    np.testing.assert_allclose(found.amplitude[0], expected, atol=2e-3)


def test_blades_have_whole_numbers(replay):
    bars = contact_distribution(replay).axes[1]
    bars.set_xlim(-0.9, 18.9)  # as with 19 blades
    assert np.all(bars.get_xticks() % 1 == 0)
