"""Select the touches and the motion of the whole machine during a recording."""

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray, IntArray
from rubgen.measurement.channel import Recording
from rubgen.solver.response import Response

COARSE_FRAMES = 48
"""Largest number of frames outside the dense turns: it limits the size of files."""


@dataclass(frozen=True, kw_only=True)
class MotionFrames:
    """True positions of the machine, frame by frame."""

    time: FloatArray
    """Time of each frame after the first sample (frames,), s, ascending."""
    angle: FloatArray
    """Angle of the blisk (frames,) in [0, 2 pi)."""
    centre: FloatArray
    """Disk centre in its turning frame (frames, 2), m."""
    tips: FloatArray
    """Radial, tangential and axial displacement of the tips in the turning frame, with steady growth (frames, n_blades,
    3), m."""
    casing: FloatArray
    """Amplitudes of the casing modes (frames, n_casing)."""
    dense: IntArray
    """1 for the frames around the hardest touch; between other frames lies at least a turn (frames,)."""
    casing_modes: FloatArray
    """X and Y of each casing mode at nodes at equal steps of polar angle from 0 (nodes, 2, n_casing)."""


def motion_frames(response: Response, recording: Recording) -> MotionFrames | None:
    """Return the frames of a run within its recording: its replay track, and Poincare sections of other turns.

    At most 48 sections are taken, at equal distances over the recording, without those that the track covers. The
    result is None where the response has no track.
    """
    track, starts = response.track, _turn_steps(response)
    if track is None:
        return None
    turns = _even_choice(starts, response, recording)
    turns = turns[(starts[turns] < track.step[0]) | (starts[turns] > track.step[-1])]
    step = np.concatenate([track.step, starts[turns]])
    turn = np.concatenate([np.searchsorted(starts, track.step, side="right") - 1, turns])
    q = np.concatenate([track.q, response.section_q[turns]])
    angle = np.concatenate([_angle(track.step, response), np.zeros(turns.size)])  # sections lie at theta = 0
    dense = np.concatenate([np.ones(track.step.size, np.int64), np.zeros(turns.size, np.int64)])
    order = np.argsort(step, kind="stable")
    order = order[_inside(step[order], response, recording)]
    step, q, m = step[order], q[order], 3 * response.n_blades
    growth = track.tip_growth[np.clip(turn[order], 0, len(track.tip_growth) - 1)]
    return MotionFrames(
        time=_seconds(step, response, recording),
        angle=angle[order],
        centre=q[:, m : m + 2],
        tips=q[:, :m].reshape(len(q), -1, 3) + growth,
        casing=q[:, q.shape[1] - response.n_casing :],
        dense=dense[order],
        casing_modes=track.casing_modes,
    )


def _turn_steps(response: Response) -> IntArray:
    """Return the first step of each turn of the record."""
    if response.changing_speed is not None:
        return response.changing_speed.turn_steps[:-1]
    return np.arange(response.record_turns) * response.steps_per_turn


def _angle(step: IntArray, response: Response) -> FloatArray:
    """Return the angle of the blisk at steps, in [0, 2 pi)."""
    if response.changing_speed is not None:
        return np.asarray(np.mod(response.changing_speed.rotation.angle(step * response.dt), 2 * np.pi))
    steps = response.steps_per_turn
    return 2 * np.pi * (step % steps) / steps


def _seconds(step: IntArray, response: Response, recording: Recording) -> FloatArray:
    return np.asarray(step * response.dt - recording.start_seconds, dtype=np.float64)


def _inside(step: IntArray, response: Response, recording: Recording) -> IntArray:
    time = _seconds(step, response, recording)
    return np.flatnonzero((time >= 0) & (time < recording.samples / recording.sample_rate_hz))


def _even_choice(starts: IntArray, response: Response, recording: Recording) -> IntArray:
    """Return the numbers of the turns that begin inside, at most `COARSE_FRAMES`, at equal distances."""
    inside = _inside(starts, response, recording)
    return np.asarray(inside[:: max(1, -(-inside.size // COARSE_FRAMES))], dtype=np.int64)


@dataclass(frozen=True, kw_only=True)
class ContactIntervals:
    """Touches that overlap a recording, in order of their end; all arrays (n_events,)."""

    blade: IntArray
    """Number of the blade."""
    start: FloatArray
    """Start in s after the first sample; negative where it began before."""
    duration: FloatArray
    """Duration in s."""
    angle: FloatArray
    """Polar angle on the casing, rad."""
    impulse: FloatArray
    """Normal impulse, N s."""
    friction_loss: FloatArray
    """Work of friction, J, <= 0."""
    normal_loss: FloatArray
    """Work lost along the normal, J, <= 0 for restitution 0."""


def contact_intervals(response: Response, recording: Recording) -> ContactIntervals:
    """Return the touches of `response` that overlap `recording`, with times in s from its first sample.

    A touch that began before the first sample has a negative start. Duration, impulse and works are of the whole touch,
    not of the part within the recording.
    """
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
