"""The orbit of the disk centre on the time line, with its points once a turn."""

from __future__ import annotations

import numpy as np
import rerun as rr

from rubgen.arrays import FloatArray, IntArray
from rubgen.viz.colors import BLUE, VERMILION, rgba
from rubgen.viz.replay import Replay
from rubgen.viz.signal_entities import detail_window, time_column

POINTS_PER_TURN = 48
COARSE_TURNS = 150


def send_orbit(stream: rr.RecordingStream, replay: Replay) -> None:
    """The recorded path turn by turn (all near the hardest touch, else up to 150), and every turn's first point; um."""
    x, y = (replay.recording.channels.get(f"proximity_{axis}") for axis in "xy")
    turns = replay.pulse_times
    if x is None or y is None or turns.size < 2:
        return
    samples = np.arange(replay.recording.samples) / replay.recording.sample_rate_hz

    def at(time: FloatArray) -> FloatArray:
        """Positions in um."""
        return 1e6 * np.stack([np.interp(time, samples, x.values), np.interp(time, samples, y.values)], axis=-1)

    line = rr.LineStrips2D.from_fields(colors=rgba(BLUE), radii=rr.Radius.ui_points(0.75))
    upwards = rr.Transform3D(mat3x3=np.diag([1.0, -1.0, 1.0]))  # the viewer's 2D views have Y downwards
    stream.log("/orbit/plane", upwards, static=True)
    stream.log("/orbit/plane/path", line, static=True)
    chosen = _drawn_turns(replay)
    share = np.linspace(0.0, 1.0, POINTS_PER_TURN + 1)
    paths = at(turns[chosen, None] + share * (turns[chosen + 1] - turns[chosen])[:, None])
    stream.send_columns("/orbit/plane/path", time_column(turns[chosen]), rr.LineStrips2D.columns(strips=list(paths)))
    points = rr.Points2D(at(turns), colors=rgba(VERMILION), radii=rr.Radius.ui_points(2.5))
    stream.log("/orbit/plane/section", points, static=True)


def _drawn_turns(replay: Replay) -> IntArray:
    """Numbers of the turns whose path is drawn."""
    turns, window = replay.pulse_times, detail_window(replay)
    first, last = (end / replay.recording.sample_rate_hz for end in (window.start, window.stop))
    number = np.arange(turns.size - 1)
    near = (turns[:-1] >= first) & (turns[1:] <= last)
    return np.asarray(number[near | (number % max(1, -(-number.size // COARSE_TURNS)) == 0)])
