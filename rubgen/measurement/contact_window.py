"""Contact events in the time of a recording."""

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray, IntArray
from rubgen.measurement.channel import Recording
from rubgen.solver.response import Response


@dataclass(frozen=True, kw_only=True)
class ContactIntervals:
    """Touches that overlap a recording, in order of their end; all arrays (n_events,).

    `start` and `duration` are in s, time 0 being the first sample (a touch may have begun before it); `angle` is the
    polar angle on the casing in rad, `impulse` the normal impulse in N s, the losses are works in J, <= 0.
    """

    blade: IntArray
    start: FloatArray
    duration: FloatArray
    angle: FloatArray
    impulse: FloatArray
    friction_loss: FloatArray
    normal_loss: FloatArray


def contact_intervals(response: Response, recording: Recording) -> ContactIntervals:
    """The contact events of `response` that overlap `recording`, in the time of its samples."""
    events, rate = response.events, recording.sample_rate_hz
    start = np.asarray(events.start_step * response.dt - recording.start_seconds, dtype=np.float64)
    duration = np.asarray(events.steps * response.dt, dtype=np.float64)
    inside = (start + duration > 0) & (start < recording.samples / rate)
    return ContactIntervals(
        blade=events.blade[inside],
        start=start[inside],
        duration=duration[inside],
        angle=events.angle[inside],
        impulse=events.impulse[inside],
        friction_loss=events.friction_loss[inside],
        normal_loss=events.normal_loss[inside],
    )
