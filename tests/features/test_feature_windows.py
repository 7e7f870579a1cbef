"""Windows of a recording: which samples they have, and that none loses a turn at its ends."""

import numpy as np
import pytest

from rubgen.errors import UserError
from rubgen.features.turns import by_turn, within
from rubgen.features.windows import Window, parse_window

RATE = 25600.0
ON_SAMPLES = [(rate, per_turn, first) for rate in (10000.0, RATE) for per_turn in (100, 256) for first in (0, 1, 33)]


def test_windows_of_a_time_follow_each_other_and_a_shorter_rest_is_left_out():
    window = parse_window("0.25 s", RATE)
    assert window.cuts(16000, RATE, np.zeros(0)) == [(0, 6400), (6400, 6400)]
    assert window.cuts(12800, RATE, np.zeros(0)) == [(0, 6400), (6400, 6400)]
    assert window.cuts(6399, RATE, np.zeros(0)) == []
    assert window.longest(6399, RATE, np.zeros(0)) == "0.249961s"


def test_windows_of_turns_have_all_samples_from_their_first_to_their_last_pulse():
    pulses = np.array([-0.4, 10.5, 110.2, 210.0, 310.9, 410.1, 510.3, 599.5]) / RATE
    cuts = parse_window("2turns", RATE).cuts(600, RATE, pulses)
    assert cuts == [(10, 201), (210, 202)]
    assert parse_window("1 turn", RATE).cuts(600, RATE, pulses[:2]) == []
    assert Window(9, "turns").longest(600, RATE, pulses) == "5turns"
    assert Window(9, "turns").longest(600, RATE, pulses[:0]) == "0turns"


@pytest.mark.parametrize(("rate", "per_turn", "first"), ON_SAMPLES)
@pytest.mark.parametrize("turns", [1, 4, 16])
def test_a_window_has_all_its_turns_where_pulses_fall_on_samples(rate, per_turn, first, turns):
    """A pulse that rounding moved beyond the first or last sample of its window is still in it."""
    samples = per_turn * 48 + first + 1
    pulses = np.arange(first, samples, per_turn) / rate
    signal = np.cos(2 * np.pi * (np.arange(samples) - first) / per_turn)
    cuts = Window(turns, "turns").cuts(samples, rate, pulses)
    assert len(cuts) == 48 // turns
    for start, size in cuts:
        assert 0 <= start < start + size <= samples
        turned = by_turn(signal[None, start : start + size], rate, pulses - start / rate)
        assert turned.shape[1] == turns
        assert turned[0, :, 0] == pytest.approx(1, abs=1e-6)


def test_pulses_outside_the_samples_do_not_count():
    places = np.array([-1.0, -1e-3, 0.0, 50.0, 99.0, 99.001, 100.0])
    np.testing.assert_array_equal(within(places / RATE, 100, RATE) * RATE, [0.0, 50.0, 99.0])


@pytest.mark.parametrize(("text", "window"), [("16turns", (16, "turns")), (" .5s ", (0.5, "s")), ("3. s", (3, "s"))])
def test_lengths_are_read_in_seconds_and_turns(text, window):
    found = parse_window(text, RATE)
    assert (found.length, found.unit) == window


def test_a_window_of_64_samples_is_the_shortest():
    assert parse_window("0.0025s", RATE).cuts(128, RATE, np.zeros(0)) == [(0, 64), (64, 64)]
    with pytest.raises(UserError, match=r"has fewer than 64 samples at 25600 Hz; give 0\.0025s or more"):
        parse_window("0.00246s", RATE)


@pytest.mark.parametrize("text", ["0turns", "0.5turns", "-1s", "s", "1e-3s", "1s 2s"])
def test_other_lengths_are_refused(text):
    with pytest.raises(UserError, match="--window"):
        parse_window(text, RATE)
