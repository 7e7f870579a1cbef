"""Order spectra as Rerun entities: the one at the cursor as bars, all of them as a waterfall."""

from __future__ import annotations

import numpy as np
import rerun as rr

from rubgen.sensors.channel import Channel
from rubgen.viz.bar_columns import send_bars
from rubgen.viz.colors import BLUE, rgba
from rubgen.viz.orders import HIGHEST_ORDER, order_map
from rubgen.viz.replay import Replay
from rubgen.viz.signal_entities import time_column

MOST_BLOCKS = 40
FLOOR = 1e-5
"""The waterfall shows 100 dB below the largest amplitude."""


def spectrum_channels(replay: Replay) -> dict[str, Channel]:
    """The first channel of each quantity but the pulse, by name."""
    groups = replay.recording.by_quantity()
    return {group[0].name: group[0] for quantity, group in groups.items() if quantity != "pulse"}


def send_orders(stream: rr.RecordingStream, replay: Replay) -> None:
    """`/spectrum/<channel>` at the beginning of each block of turns, `/waterfall/<channel>` of all of them in dB."""
    for name, channel in spectrum_channels(replay).items():
        found = order_map(channel.values, replay.recording.sample_rate_hz, replay.pulse_times, most_blocks=MOST_BLOCKS)
        if not found.amplitude.size or not found.amplitude.any():
            continue
        left = found.order - found.order[0] / 2
        send_bars(stream, f"/spectrum/{name}", time_column(found.time), found.amplitude, left, rgba(BLUE))
        decibel = 20 * np.log10(np.maximum(found.amplitude / found.amplitude.max(), FLOOR))
        names = ["time", f"order 0 to {HIGHEST_ORDER}"]
        stream.log(f"/waterfall/{name}", rr.Tensor(decibel.astype(np.float16), dim_names=names), static=True)
