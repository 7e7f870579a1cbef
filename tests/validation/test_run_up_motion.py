"""What the page on run-ups says of pairs of a steady run and a window."""

import pytest

from rubgen.labels import Motion
from validation.run_up_motion import CHOSEN, DURATIONS_S, SPEEDS_RPM, Pair, page, run_up_scenario

CHAOTIC, PERIOD_1, UNDECIDED = Motion.CHAOTIC, Motion.PERIOD_1, Motion.UNDECIDED


@pytest.mark.parametrize(
    ("steady", "window", "verdict"),
    [
        (CHAOTIC, CHAOTIC, "agree"),
        (UNDECIDED, UNDECIDED, "undecided"),
        (CHAOTIC, UNDECIDED, "undecided"),
        (UNDECIDED, PERIOD_1, "undecided"),
        (CHAOTIC, PERIOD_1, "contradict"),
    ],
)
def test_only_two_classes_contradict_each_other(steady, window, verdict):
    assert Pair("preset", 7.3, 9000.0, steady, window, True).verdict == verdict


def test_the_page_counts_what_it_lists():
    every = [
        Pair(name, seconds, speed, CHAOTIC, CHAOTIC if speed < 12000 else PERIOD_1, speed > 7000)
        for name in CHOSEN
        for seconds in DURATIONS_S
        for speed in SPEEDS_RPM
    ]
    text = page(every, {("preset", 7.3): "chaotic from 6,400"})
    assert "Of 44 pairs 36 agree on a class." in text
    assert "Blades touch in 40 of\nthe 44 steady runs." in text
    assert "No steady run of these is period-1 or period-k or quasi-periodic" in text
    assert "8 contradict each other." in text
    assert "| chaotic | 8 | 36 |" in text
    assert "- preset, 904 rev/min/s: chaotic from 6,400." in text
    assert text.count("| preset | ") == len(SPEEDS_RPM)


def test_run_ups_pass_every_steady_speed():
    for seconds in DURATIONS_S:
        operation = run_up_scenario("preset", seconds).operation
        assert operation.speed_rpm < min(SPEEDS_RPM) < max(SPEEDS_RPM) < operation.end_speed_rpm
