"""Order spectra of made signals."""

import numpy as np
import pytest

from rubgen.viz.derived import order_map

RATE = 25600.0


def swept(seconds=4.0):
    """A run-up from 50 to 150 turns a second: time, angle in turns, pulses."""
    time = np.arange(round(seconds * RATE)) / RATE
    turns = 50 * time + 100 * time**2 / (2 * seconds)
    return turns, np.interp(np.arange(int(turns[-1]) + 1), turns, time)


def test_orders_stay_sharp_while_the_speed_changes():
    turns, pulses = swept()
    values = (3.0 * np.cos(2 * np.pi * 2 * turns) + 0.5 * np.cos(2 * np.pi * 4.5 * turns)).astype(np.float32)
    found = order_map(values, RATE, pulses)
    assert found.amplitude.shape == (len(found.time), 192)
    second, half = (int(np.argmin(np.abs(found.order - order))) for order in (2.0, 4.5))
    assert found.amplitude[:, second] == pytest.approx(np.full(len(found.time), 3.0), rel=0.01)
    assert found.amplitude[:, half] == pytest.approx(np.full(len(found.time), 0.5), rel=0.02)
    rest = np.delete(found.amplitude, [second, half], axis=1)
    assert rest.max() < 0.05


def test_blocks_are_thinned_and_keep_their_times():
    turns, pulses = swept()
    found = order_map(np.cos(2 * np.pi * turns).astype(np.float32), RATE, pulses, most_blocks=5)
    assert len(found.time) <= 5
    assert set(found.time) <= set(pulses)


def test_a_recording_without_turns_has_no_spectrum():
    for pulses in (np.zeros(0), np.array([0.01])):
        assert order_map(np.zeros(100, np.float32), RATE, pulses).amplitude.size == 0


def test_blocks_with_lost_samples_are_left_out():
    turns, pulses = swept()
    values = np.cos(2 * np.pi * turns).astype(np.float32)
    whole = order_map(values, RATE, pulses)
    values[np.searchsorted(turns, 3 * 16 + 5.0)] = np.nan  # in the fourth block of sixteen turns
    found = order_map(values, RATE, pulses)
    np.testing.assert_array_equal(found.time, np.delete(whole.time, 3))
    np.testing.assert_array_equal(found.amplitude, np.delete(whole.amplitude, 3, axis=0))
