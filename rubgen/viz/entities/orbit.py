"""Send the orbit of the disk centre to Rerun, with its points once a turn."""

from dataclasses import dataclass

import numpy as np
import rerun as rr

from rubgen.arrays import FloatArray, IntArray
from rubgen.viz.colors import BLUE, GREY, VERMILION, rgba
from rubgen.viz.derived import poincare_section, shaft_orbit
from rubgen.viz.entities.signals import detail_window, time_column
from rubgen.viz.replay import Replay

POINTS_PER_TURN = 48
COARSE_TURNS = 100


def send_orbit(stream: rr.RecordingStream, replay: Replay) -> None:
    """Send the recorded orbit turn by turn, and its first point of every turn, in um.

    All turns near the hardest touch are sent, and up to 100 other turns. Nothing is sent without a pair of probes, or
    with fewer than two pulses.
    """
    orbit, turns = shaft_orbit(replay), replay.pulse_times
    if orbit is None or turns.size < 2:
        return
    samples = np.arange(replay.recording.samples) / replay.recording.sample_rate_hz

    def at(time: FloatArray) -> FloatArray:
        """Positions in um."""
        return np.stack([np.interp(time, samples, values) for values in orbit], axis=-1)

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
    _send_scale(stream, "orbit", orbit_bounds(replay))
    _send_scale(stream, "section", section_bounds(replay))


@dataclass(frozen=True)
class Bounds:
    """The visible square in the plane of the orbit: its middle and half a side in um, X to the right and Y upward."""

    x: float
    y: float
    half: float


def orbit_bounds(replay: Replay) -> Bounds:
    """Return the square that shows the whole recorded orbit."""
    return _bounds(shaft_orbit(replay), least=1.0)


def section_bounds(replay: Replay) -> Bounds:
    """Return the square that shows the points once a turn."""
    return _bounds(poincare_section(replay), least=0.1)


def _bounds(places: FloatArray | None, least: float) -> Bounds:
    """Return the square that shows places (2, any), um; around 0 without any."""
    if places is None or not places.size:
        return Bounds(0.0, 0.0, least)
    low, high = np.nanmin(places, axis=1).tolist(), np.nanmax(places, axis=1).tolist()
    half = 0.6 * max(high[0] - low[0], high[1] - low[1], least)
    return Bounds((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, half)


def _send_scale(stream: rr.RecordingStream, name: str, bounds: Bounds) -> None:
    """Send a bar of a round length in the lower left corner, because the viewer's planes have no axes."""
    wanted = 0.6 * bounds.half
    power = 10.0 ** np.floor(np.log10(wanted))
    length = max(step * power for step in (1, 2, 5) if step * power <= wanted)
    left, low = bounds.x - 0.9 * bounds.half, bounds.y - 0.8 * bounds.half
    bar = rr.LineStrips2D(
        [[[left, low], [left + length, low]]], colors=rgba(GREY), radii=rr.Radius.ui_points(1.5),
        labels=f"{length:g} um", show_labels=True,
    )  # fmt: skip
    stream.log(f"/orbit/plane/scale/{name}", bar, static=True)


def _drawn_turns(replay: Replay) -> IntArray:
    """Return the numbers of the turns whose path is drawn."""
    turns, window = replay.pulse_times, detail_window(replay)
    first, last = (end / replay.recording.sample_rate_hz for end in (window.start, window.stop))
    number = np.arange(turns.size - 1)
    near = (turns[:-1] >= first) & (turns[1:] <= last)
    return np.asarray(number[near | (number % max(1, -(-number.size // COARSE_TURNS)) == 0)])
