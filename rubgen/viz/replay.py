"""What a replay shows, from memory or from a file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.labels.plain import labels_dict
from rubgen.scenario import Scenario
from rubgen.sensors.channel import Recording
from rubgen.sensors.contact_window import ContactIntervals, contact_intervals
from rubgen.sensors.motion_frames import MotionFrames, motion_frames

if TYPE_CHECKING:
    from rubgen.pipeline import Run


@dataclass(frozen=True, kw_only=True)
class Replay:
    """One run to look at: labels by their public names, touches in order of their beginning, frames of the motion.

    `frames` is None where a file holds none: there is no 3D scene then.
    """

    scenario: Scenario
    labels: dict[str, object]
    recording: Recording
    touches: ContactIntervals
    frames: MotionFrames | None

    @property
    def seconds(self) -> float:
        """Length of the recording in s."""
        return self.recording.samples / self.recording.sample_rate_hz

    @property
    def turn_seconds(self) -> float:
        """Mean duration of a turn in s."""
        pulses = self.recording.once_per_rev
        return float(np.diff(pulses).mean()) if pulses.size > 1 else 60 / self.scenario.operation.speed_rpm

    @property
    def pulse_times(self) -> FloatArray:
        """Times in s at which a turn begins, (turns,)."""
        return self.recording.once_per_rev


def replay_of(run: Run) -> Replay:
    """A run in memory as a replay; raises ValueError for a run without a recording."""
    if run.recording is None or run.labels is None:
        raise ValueError(f"{run.scenario.run_id} has status {run.response.status.code}: there is nothing to show")
    touches = contact_intervals(run.response, run.recording)
    return Replay(
        scenario=run.scenario,
        labels=labels_dict(run.labels),
        recording=run.recording,
        touches=sorted_touches(touches),
        frames=motion_frames(run.response, run.recording),
    )


def sorted_touches(touches: ContactIntervals) -> ContactIntervals:
    """The touches in order of their beginning."""
    order = np.argsort(touches.start, kind="stable")
    return ContactIntervals(**{name: getattr(touches, name)[order] for name in ContactIntervals.__dataclass_fields__})
