"""Touches in the time of a recording: those that overlap it, whole."""

from dataclasses import replace

import numpy as np

from rubgen.measurement.motion import contact_intervals
from rubgen.solver.response import ContactEvents


def test_touches_that_overlap_the_recording_are_kept_whole(rub_run):
    """One before, one over its start, one inside, one over its end, one after."""
    response, recording = rub_run.response, rub_run.recording
    dt, start = response.dt, recording.start_seconds
    seconds = recording.samples / recording.sample_rate_hz
    begin = start + np.array([-0.5, -1e-3, 0.5 * seconds, seconds - 1e-3, seconds + 0.1])
    first, steps = np.rint(begin / dt).astype(np.int64), np.full(5, round(2e-3 / dt))
    number = np.arange(5.0)
    events = ContactEvents(
        blade=np.arange(5), start_step=first, steps=steps, angle=number, impulse=10 + number,
        friction_loss=-number, normal_loss=-2 * number,
    )  # fmt: skip
    found = contact_intervals(replace(response, events=events), recording)
    np.testing.assert_array_equal(found.blade, [1, 2, 3])
    np.testing.assert_allclose(found.start, first[1:4] * dt - start, atol=1e-12)
    np.testing.assert_allclose(found.duration, 2e-3, atol=dt)
    assert found.start[0] < 0 < found.start[0] + found.duration[0]
    assert found.start[2] < seconds < found.start[2] + found.duration[2]
    for name, expected in (("angle", 1.0), ("impulse", 11.0), ("friction_loss", -1.0), ("normal_loss", -2.0)):
        assert getattr(found, name)[0] == expected
