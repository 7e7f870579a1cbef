"""Send events to Rerun: touches over time and as a map of blades and casing angles, and blade tip timing."""

import numpy as np
import rerun as rr

from rubgen.arrays import FloatArray, IntArray
from rubgen.measurement.blade_tip_timing import tip_deflections
from rubgen.viz.colors import BLUE, ORANGE, rgba
from rubgen.viz.derived import sector_of
from rubgen.viz.entities.signals import time_column
from rubgen.viz.replay import Replay

MOST_TOUCHES = 2000
SECTORS = 72
MOST_PASSAGES = 4000
"""Largest number of passages of all probes, 90 kB."""


def shown_touches(replay: Replay, *, full: bool) -> IntArray:
    """Return the ascending indices, in `replay.touches`, of the touches that are drawn one by one.

    They are all touches with `full`, else the 2,000 with the largest impulse.
    """
    impulse = replay.touches.impulse
    if full or impulse.size <= MOST_TOUCHES:
        return np.arange(impulse.size)
    return np.sort(np.argpartition(impulse, -MOST_TOUCHES)[-MOST_TOUCHES:])


def send_touches(stream: rr.RecordingStream, replay: Replay, *, full: bool) -> None:
    """Send angle, impulse and blade of touches at their start, and their map. Nothing is sent without contact.

    A touch that began before the first sample is at time 0. The touches that are sent one by one are chosen by
    `shown_touches` with the same `full`. The map has all touches.
    """
    touches, shown = replay.touches, shown_touches(replay, full=full)
    if not shown.size:
        return
    index = time_column(np.maximum(touches.start[shown], 0.0))
    for name, unit, values in (
        ("angle", "deg", np.mod(np.degrees(touches.angle) + 90, 360) - 90),  # zones at 0 and 180 stay in one piece
        ("impulse", "N s", touches.impulse),
        ("blade", "number", touches.blade.astype(np.float64)),
    ):
        points = rr.SeriesPoints(names=f"{name} [{unit}]", markers="circle", marker_sizes=1.5, colors=rgba(ORANGE))
        stream.log(f"/contact/{name}", points, static=True)
        stream.send_columns(f"/contact/{name}", index, rr.Scalars.columns(scalars=values[shown]))
    sectors = [f"casing angle from -90 deg on, {360 // SECTORS} deg each", "blade"]
    shifted = np.roll(contact_map(replay), SECTORS // 4, axis=0)
    stream.log("/contact/map", rr.Tensor(shifted.astype(np.float32), dim_names=sectors), static=True)


def contact_map(replay: Replay) -> FloatArray:
    """Return the normal impulse (SECTORS, n_blades) in mN s by sector and blade. Sector 0 is centred at angle 0."""
    touches, blades = replay.touches, replay.scenario.machine.blades.count
    place = sector_of(touches.angle, SECTORS) * blades + touches.blade.astype(np.int64)
    total = np.bincount(place, weights=touches.impulse, minlength=SECTORS * blades)
    return np.asarray(1e3 * total.reshape(SECTORS, blades), dtype=np.float64)


def send_tip_timing(stream: rr.RecordingStream, replay: Replay, *, full: bool) -> None:
    """Send the tip deflections from each probe's arrival times, in um, as points at these times.

    With `full` all points are sent. Without it, if there are many, all points around the hardest touch and some of the
    rest are sent.
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
    """Return numbers of at most `most` of ascending times: half nearest to the hardest touch, half spread evenly."""
    number = np.arange(time.size)
    if time.size <= most:
        return number
    middle = int(np.searchsorted(time, replay.hardest_touch))
    first = min(max(middle - most // 4, 0), time.size - most // 2)
    return np.union1d(number[first : first + most // 2], number[:: -(-time.size // (most // 2))])
