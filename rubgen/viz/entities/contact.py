"""Touches as Rerun entities: points over time, and the map of blades and casing angles."""

import numpy as np
import rerun as rr

from rubgen.arrays import FloatArray, IntArray
from rubgen.viz.colors import ORANGE, rgba
from rubgen.viz.entities.signals import time_column
from rubgen.viz.replay import Replay
from rubgen.viz.sectors import sector_of

MOST_TOUCHES = 2000
SECTORS = 72


def shown_touches(replay: Replay, *, full: bool) -> IntArray:
    """Numbers of the touches that are drawn one by one: all, or the 2,000 with the largest impulse."""
    impulse = replay.touches.impulse
    if full or impulse.size <= MOST_TOUCHES:
        return np.arange(impulse.size)
    return np.sort(np.argpartition(impulse, -MOST_TOUCHES)[-MOST_TOUCHES:])


def send_touches(stream: rr.RecordingStream, replay: Replay, *, full: bool) -> None:
    """Angle, impulse and blade of touches at their beginning, and their map; nothing without contact."""
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
    """Normal impulse (SECTORS, n_blades) in mN s by sector of the casing, the first about 0, and blade."""
    touches, blades = replay.touches, replay.scenario.machine.blades.count
    place = sector_of(touches.angle, SECTORS) * blades + touches.blade.astype(np.int64)
    total = np.bincount(place, weights=touches.impulse, minlength=SECTORS * blades)
    return np.asarray(1e3 * total.reshape(SECTORS, blades), dtype=np.float64)
