"""What the summary of a run says of a record whose speed changes."""

import dataclasses

import pytest

from rubgen.cli.commands.simulating import run_summary
from rubgen.labels.labels import Motion
from rubgen.labels.speed_history import Change, SpeedHistory


def summary(run, *rubs):
    """The summary where the rub of one stretch after the other is as given; speeds of 900 and 1100 rad/s."""
    changes = tuple(
        Change(time=time, speed=900.0, rub=rub, impulse=0.1, blisk=motion, casing=motion, motion=motion)
        for time, rub in enumerate(rubs)
        for motion in [Motion.UNDECIDED]
    )
    speeds = (900.0, 1100.0) if any(rubs) else (None, None)
    history = SpeedHistory(changes=changes, onset_speed=speeds[0], end_of_rub_speed=speeds[1])
    return dict(run_summary(dataclasses.replace(run, labels=dataclasses.replace(run.labels, history=history))))


@pytest.mark.parametrize(
    ("rubs", "onset", "end"),
    [
        ((False, True, False), "8,594.4 rev/min", "10,504 rev/min"),
        ((False, True), "8,594.4 rev/min", "none, it goes on at the end of the record"),
        ((True, False), "before the record", "10,504 rev/min"),
        ((True,), "before the record", "none, it goes on at the end of the record"),
        ((False,), "none", "none"),
    ],
)
def test_a_rub_ends_where_it_stops_and_not_where_the_record_does(rub_run, rubs, onset, end):
    told = summary(rub_run, *rubs)
    assert (told["onset of rub"], told["end of rub"]) == (onset, end)
    assert told["changes"] == f"{len(rubs) - 1} of rub or motion over the record"


def test_a_fault_that_grows_has_a_first_touch_and_the_penetration_of_the_start(rub_run):
    response = rub_run.response
    growing = dict(run_summary(dataclasses.replace(rub_run, response=dataclasses.replace(response, grows=True))))
    onset = response.events.start_step.min() * response.dt
    assert growing["first touch"] == f"{onset:.4g} s after the start of the record"
    assert growing["penetration"].endswith("had there been no contact at the start of the record")
    steady = dict(run_summary(rub_run))
    assert "first touch" not in steady
    assert steady["penetration"].endswith("had there been no contact")
