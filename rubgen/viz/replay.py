"""What is needed to show a run, from memory or from a file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.errors import NoPictureError
from rubgen.labels.headline import headline
from rubgen.labels.to_json import MOTION_LABELS, labels_to_json, motion_classes
from rubgen.measurement.channel import Recording
from rubgen.measurement.motion import ContactIntervals, MotionFrames, contact_intervals, motion_frames
from rubgen.scenario import Scenario
from rubgen.units import rev_per_min

if TYPE_CHECKING:
    from rubgen.pipeline import Run


@dataclass(frozen=True, kw_only=True)
class Replay:
    """One run for display, in plain values, without the true response."""

    scenario: Scenario
    labels: dict[str, object]
    """Labels by their public names."""
    recording: Recording
    touches: ContactIntervals
    """Touches in order of their start."""
    frames: MotionFrames | None
    """Frames of the motion; None where a file has none. Then there is no 3D scene."""
    motion_classes: dict[str, list[tuple[float, str]]]
    """For each of `motion`, `motion_blisk`, `motion_casing`, its classes with the times in s from which they are
    valid."""

    @property
    def title(self) -> str:
        """Name of the run and of the machine, and its speed, or its first and last speed, in rev/min.

        A fluctuating speed is its mean ± its amplitude.
        """
        rotation = self.scenario.operation.rotation
        start, end = (f"{rev_per_min(speed):,.0f}" for speed in (rotation.start, rotation.end))
        speed = start if start == end else f"{start} to {end}"
        if rotation.swing:
            speed += f" ± {rev_per_min(abs(rotation.swing)):,.0f}"
        return f"{self.scenario.run_id}: {self.scenario.machine.name} at {speed} rev/min"

    @property
    def headline(self) -> str:
        """One line on whether, and from which speed, the run rubs, and how it moves: `rubgen.labels.headline`."""
        return headline(self.labels, self.scenario.operation.profile)

    @property
    def hardest_touch(self) -> float:
        """Start in s of the touch with the largest impulse, at least 0; the middle of the recording without touches."""
        touches = self.touches
        if not touches.impulse.size:
            return self.seconds / 2
        return min(max(float(touches.start[np.argmax(touches.impulse)]), 0.0), self.seconds)

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

    @property
    def closed(self) -> FloatArray:
        """How far faults have closed the clearance at each frame (frames,), m; empty without frames."""
        time = self.frames.time + self.recording.start_seconds if self.frames else np.zeros(0)
        machine, closed = self.scenario.machine, np.zeros(time.size)
        for each in (each for fault in machine.faults for each in fault.narrowings(machine)):
            closed += each.amount_m * each.ramp.share(time)
        return closed


def replay_of(run: Run) -> Replay:
    """Make the replay of a run in memory. Raises NoPictureError, a ValueError, for a run without a recording."""
    if run.recording is None or run.labels is None:
        raise NoPictureError(f"{run.scenario.run_id} has status {run.response.status.code}: there is nothing to show")
    touches, recording = contact_intervals(run.response, run.recording), run.recording
    seconds = recording.samples / recording.sample_rate_hz
    classes = motion_classes(run.labels, recording.start_seconds, seconds)
    return Replay(
        scenario=run.scenario,
        labels=labels_to_json(run.labels),
        recording=run.recording,
        touches=sorted_touches(touches),
        frames=motion_frames(run.response, run.recording),
        motion_classes={name: [(time, names[name]) for time, names in classes] for name in MOTION_LABELS},
    )


def sorted_touches(touches: ContactIntervals) -> ContactIntervals:
    """Return the touches sorted by their start."""
    order = np.argsort(touches.start, kind="stable")
    return ContactIntervals(**{name: getattr(touches, name)[order] for name in ContactIntervals.__dataclass_fields__})
