"""Blade tip timing as Rerun entities."""

import numpy as np
import rerun as rr

from rubgen.arrays import FloatArray, IntArray
from rubgen.measurement.blade_tip_timing import tip_deflections
from rubgen.viz.colors import BLUE, rgba
from rubgen.viz.entities.signals import time_column
from rubgen.viz.replay import Replay

MOST_PASSAGES = 4000
"""Most passages of all probes together, 90 kB."""


def send_tip_timing(stream: rr.RecordingStream, replay: Replay, *, full: bool) -> None:
    """Deflections that follow from each probe's arrival times, in um, as points at those times.

    All (`full`), or where they are many those about the hardest touch and every few of the others.
    """
    recording, radius = replay.recording, replay.scenario.machine.tip_radius_m
    most = MOST_PASSAGES // max(len(recording.tip_timing), 1)
    for name, seen in recording.tip_timing.items():
        deflection = 1e6 * tip_deflections(seen, recording.once_per_rev, radius)
        known = np.flatnonzero(np.isfinite(deflection))
        if not full:
            known = known[_chosen(seen.time[known], replay, most)]
        points = rr.SeriesPoints(names=f"{name} [um]", markers="circle", marker_sizes=1.5, colors=rgba(BLUE))
        stream.log(f"/blade_tip_timing/{name}", points, static=True)
        index = time_column(np.maximum(seen.time[known], 0.0))
        stream.send_columns(f"/blade_tip_timing/{name}", index, rr.Scalars.columns(scalars=deflection[known]))


def _chosen(time: FloatArray, replay: Replay, most: int) -> IntArray:
    """Numbers of at most `most` of ascending times: half of them nearest to the hardest touch, half evenly spread."""
    number = np.arange(time.size)
    if time.size <= most:
        return number
    middle = int(np.searchsorted(time, replay.hardest_touch))
    first = min(max(middle - most // 4, 0), time.size - most // 2)
    return np.union1d(number[first : first + most // 2], number[:: -(-time.size // (most // 2))])
