"""Send the signals of a replay to Rerun: a preview of all, and every sample around the hardest touch."""

import numpy as np
import numpy.typing as npt
import rerun as rr

from rubgen.arrays import FloatArray
from rubgen.measurement.channel import PREVIEW_RATE_HZ, preview
from rubgen.viz.colors import LINES, rgba
from rubgen.viz.replay import Replay

TIMELINE = "time"
DETAIL_TURNS = 20
DETAIL_VALUES = 28_000
"""Largest number of full-rate values of all channels: 224 kB, for any speed and number of channels."""
PREVIEW_VALUES = 24_000
"""Largest number of preview values of all channels: 192 kB, for any length."""
UNSHOWN = "pulse"
"""The quantity of the pulses. They are shown as points of the orbit, and left out here unless all is wanted."""
Nanoseconds = npt.NDArray[np.timedelta64]


def shown_channels(replay: Replay) -> int:
    """Return the number of channels whose signals are sent without `full`: all but the pulses."""
    return sum(channel.quantity != UNSHOWN for channel in replay.recording.channels.values())


def detail_window(replay: Replay) -> slice:
    """Return the range of samples that are sent at full rate: 20 turns around the hardest touch.

    If turns are long or channels many, the range has fewer turns. Without contact it is the middle of the recording.
    """
    recording, samples = replay.recording, replay.recording.samples
    length = round(DETAIL_TURNS * replay.turn_seconds * recording.sample_rate_hz)
    length = min(samples, length, DETAIL_VALUES // shown_channels(replay))
    centre = round(replay.hardest_touch * recording.sample_rate_hz)
    first = min(max(centre - length // 2, 0), samples - length)
    return slice(first, first + length)


def times_ns(seconds: FloatArray) -> Nanoseconds:
    """Round times in s to whole ns."""
    return np.round(seconds * 1e9).astype("timedelta64[ns]")


def time_column(seconds: FloatArray) -> list[rr.TimeColumn]:
    """Return Rerun's index for rows at these times, s."""
    return [rr.TimeColumn(TIMELINE, duration=times_ns(seconds))]


def preview_rate(replay: Replay) -> float:
    """Return the number of bins per second of the preview: limited by PREVIEW_VALUES, at most PREVIEW_RATE_HZ."""
    columns = 2 * shown_channels(replay)
    return min(PREVIEW_RATE_HZ, PREVIEW_VALUES / (columns * replay.seconds))


def send_signals(stream: rr.RecordingStream, replay: Replay, *, full: bool) -> None:
    """Send every channel as preview and at full rate over the `detail_window`, one entity for each quantity.

    The pulses are sent only with `full`, which sends the whole recording at full rate. Minimum and maximum of a bin of
    the preview have the colour of their channel.
    """
    recording, rate = replay.recording, replay.recording.sample_rate_hz
    window = slice(0, recording.samples) if full else detail_window(replay)
    times = np.arange(window.start, window.stop) / rate
    for quantity, group in recording.by_quantity().items():
        if quantity == UNSHOWN and not full:
            continue
        colors = [rgba(LINES[place % len(LINES)]) for place in range(len(group))]
        shown = preview(group, rate, preview_rate(replay))
        names = [f"{name} [{group[0].unit}]" for name in shown.names]
        pairs = [color for color in colors for _ in range(2)]
        _send_scalars(stream, f"/preview/{quantity}", shown.first / rate, shown.values, names, pairs)
        values = np.column_stack([channel.values[window] for channel in group]).astype(np.float64)
        names = [f"{channel.name} [{channel.unit}]" for channel in group]
        _send_scalars(stream, f"/detail/{quantity}", times, values, names, colors)


def _send_scalars(
    stream: rr.RecordingStream, entity: str, times: FloatArray, values: FloatArray, names: list[str], colors: list[int]
) -> None:
    """Send lines of one entity: `values` (n, len(names)). Spikes remain when zooming out."""
    policy = rr.components.AggregationPolicy.MinMax
    lines = rr.SeriesLines(names=names, colors=np.array(colors, np.uint32), aggregation_policy=policy)
    stream.log(entity, lines, static=True)
    columns = rr.Scalars.columns(scalars=values.ravel()).partition([len(names)] * len(values))
    stream.send_columns(entity, time_column(times), columns)
