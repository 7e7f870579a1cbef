"""Blade tip timing as Rerun entities."""

from __future__ import annotations

import numpy as np
import rerun as rr

from rubgen.sensors.blade_tip_timing import tip_deflections
from rubgen.viz.colors import BLUE, rgba
from rubgen.viz.replay import Replay
from rubgen.viz.signal_entities import time_column


def send_tip_timing(stream: rr.RecordingStream, replay: Replay) -> None:
    """Deflections that follow from each probe's arrival times, in um, as points at those times."""
    recording, radius = replay.recording, replay.scenario.machine.tip_radius_m
    for name, seen in recording.tip_timing.items():
        deflection = 1e6 * tip_deflections(seen, recording.once_per_rev, radius)
        known = np.isfinite(deflection)
        points = rr.SeriesPoints(names=f"{name} [um]", markers="circle", marker_sizes=1.5, colors=rgba(BLUE))
        stream.log(f"/blade_tip_timing/{name}", points, static=True)
        index = time_column(np.maximum(seen.time[known], 0.0))
        stream.send_columns(f"/blade_tip_timing/{name}", index, rr.Scalars.columns(scalars=deflection[known]))
