"""The motion of a window is what that stretch shows, whatever the record as a whole is called."""

from types import SimpleNamespace

import numpy as np
import pytest

from rubgen.labels.labels import Motion
from rubgen.labels.motion.classify import Motions
from rubgen.labels.motion.decision import AT_REST, FORCED, MotionClass
from rubgen.labels.motion.drifting import UNDECIDED
from rubgen.labels.motion.intermittency import segments
from rubgen.labels.stretches import window_motions


def whole(motion, period=None, confidence=0.9, stretches=()):
    found = MotionClass(motion=motion, period=period, confidence=confidence)
    return Motions(blisk=found, casing=AT_REST, system=found, stretches=stretches)


def record(turns):
    return SimpleNamespace(record_turns=turns, changing_speed=None, grows=False)


@pytest.mark.parametrize("motion", [Motion.PERIOD_1, Motion.PERIOD_K, Motion.QUASI_PERIODIC])
def test_a_motion_that_goes_on_is_the_motion_of_every_window(motion):
    assert window_motions(record(40), whole(motion), None) == ((motion, 0.9),) * 3


def test_forced_motion_is_sure_and_undecided_motion_has_no_confidence():
    forced = Motions(blisk=FORCED, casing=AT_REST, system=FORCED)
    assert window_motions(record(16), forced, None) == ((Motion.PERIOD_1, 1.0),)
    unknown = Motions(blisk=UNDECIDED, casing=UNDECIDED, system=UNDECIDED)
    assert window_motions(record(16), unknown, None) == ((Motion.UNDECIDED, None),)


def test_windows_of_a_chaotic_record_are_regular_where_its_points_repeat():
    """The logistic map repeats after three turns from turn 64 to 143, and is chaotic before and after."""
    values = np.empty(240)
    values[0] = 0.3
    for turn in range(1, 240):
        rate = 3.8319 if 64 <= turn < 144 else 4.0
        values[turn] = rate * values[turn - 1] * (1 - values[turn - 1])
    orbit = values[100:103].copy()
    values[64:144] = orbit[np.arange(80) % 3]  # settled from the first turn on
    found = segments([(values / np.ptp(values))[:, None, None]])
    windows = window_motions(record(240), whole(Motion.CHAOTIC, stretches=tuple(found)), None)
    for number, (motion, confidence) in enumerate(windows):
        part = values[16 * number : 16 * number + 16]
        repeats = np.allclose(part[3:], part[:-3], atol=1e-12)
        assert (motion is Motion.PERIOD_K) == repeats, number
        if motion is Motion.CHAOTIC:
            assert confidence == 0.9
        else:
            assert confidence is None
    assert [motion for motion, _ in windows].count(Motion.PERIOD_K) == 5
    assert [motion for motion, _ in windows].count(Motion.CHAOTIC) >= 8


def test_a_window_of_two_classes_is_undecided():
    changes = [SimpleNamespace(time=0.0, motion=Motion.PERIOD_1), SimpleNamespace(time=2.5, motion=Motion.CHAOTIC)]
    response = SimpleNamespace(record_turns=64, changing_speed=None, turn_seconds=1 / 16)
    found = window_motions(response, whole(Motion.UNDECIDED), SimpleNamespace(changes=changes))
    assert found == (
        (Motion.PERIOD_1, None),
        (Motion.PERIOD_1, None),
        (Motion.UNDECIDED, None),
        (Motion.CHAOTIC, None),
    )
