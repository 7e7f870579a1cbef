"""The motion of the whole machine in the time of a recording: dense about the hardest touch, once a turn elsewhere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray, IntArray
from rubgen.sensors.channel import Recording
from rubgen.solver.response import Response

COARSE_FRAMES = 60
"""Most frames outside the dense turns: what keeps a file small whatever its length."""


@dataclass(frozen=True, kw_only=True)
class MotionFrames:
    """True positions at `time` (frames,) in s after the first sample, ascending.

    `angle` (frames,) is the blisk's in [0, 2 pi); the disk centre `centre` (frames, 2) and the tips' displacements
    `tips` (frames, n_blades, 3) (radial, tangential, axial, steady growth included) are in its turning frame, in m.
    `casing` (frames, n_casing) are amplitudes of `casing_modes` (nodes, 2, n_casing), X and Y at equal steps of polar
    angle from 0. `dense` marks the frames about the hardest touch; between the others lies a turn or more.
    """

    time: FloatArray
    angle: FloatArray
    centre: FloatArray
    tips: FloatArray
    casing: FloatArray
    dense: IntArray
    casing_modes: FloatArray


def motion_frames(response: Response, recording: Recording) -> MotionFrames | None:
    """The frames of a run that lie within its recording: its replay track, and sections once a turn or more rarely.

    None where the response kept no track.
    """
    track, steps = response.track, response.steps_per_turn
    if track is None:
        return None
    sections = _even_choice(np.arange(response.record_turns) * steps, response, recording)
    sections = sections[(sections < track.step[0]) | (sections > track.step[-1])]
    step = np.concatenate([track.step, sections])
    q = np.concatenate([track.q, response.section_q[sections // steps]])
    dense = np.concatenate([np.ones(track.step.size, np.int64), np.zeros(sections.size, np.int64)])
    order = np.argsort(step, kind="stable")
    order = order[_inside(step[order], response, recording)]
    step, q, m = step[order], q[order], 3 * response.n_blades
    return MotionFrames(
        time=_seconds(step, response, recording),
        angle=2 * np.pi * (step % steps) / steps,
        centre=q[:, m : m + 2],
        tips=q[:, :m].reshape(len(q), -1, 3) + track.tip_growth,
        casing=q[:, q.shape[1] - response.n_casing :],
        dense=dense[order],
        casing_modes=track.casing_modes,
    )


def _seconds(step: IntArray, response: Response, recording: Recording) -> FloatArray:
    return np.asarray(step * response.dt - recording.start_seconds, dtype=np.float64)


def _inside(step: IntArray, response: Response, recording: Recording) -> IntArray:
    time = _seconds(step, response, recording)
    return np.flatnonzero((time >= 0) & (time < recording.samples / recording.sample_rate_hz))


def _even_choice(step: IntArray, response: Response, recording: Recording) -> IntArray:
    """Those of the steps that lie inside, at most `COARSE_FRAMES`, equally far apart."""
    inside = step[_inside(step, response, recording)]
    return np.asarray(inside[:: max(1, -(-inside.size // COARSE_FRAMES))], dtype=np.int64)
