"""Send order spectra to Rerun: the spectrum at the cursor as bars, all spectra as a waterfall."""

import numpy as np
import pyarrow as pa
import rerun as rr

from rubgen.arrays import FloatArray
from rubgen.measurement.channel import Channel, Float32Array
from rubgen.viz.colors import BLUE, rgba
from rubgen.viz.derived import HIGHEST_ORDER, order_map
from rubgen.viz.entities.signals import UNSHOWN, time_column
from rubgen.viz.replay import Replay

MOST_BLOCKS = 32
FIRST = ("contact_force", "casing_acc_0", "proximity_x", "blisk_x")
"""Channels with spectra. Each spectrum takes up to 50 kB of the file, so there are no others."""
FLOOR = 1e-5
"""The waterfall shows 100 dB below the largest amplitude."""


def spectrum_channels(replay: Replay) -> dict[str, Channel]:
    """Return the recorded channels that have spectra, by name: the channels of `FIRST`.

    If none of them was recorded, it is the first channel that is not the pulse.
    """
    channels = replay.recording.channels
    names = [name for name in FIRST if name in channels]
    names = names or [name for name, channel in channels.items() if channel.quantity != UNSHOWN][:1]
    return {name: channels[name] for name in names}


def send_orders(stream: rr.RecordingStream, replay: Replay) -> None:
    """Send the spectra (`order_map`) of each channel of `spectrum_channels` to the recording `stream`.

    - `/spectrum/<channel>`: a row of bars for each block of turns, at the time when the block begins. The bars are peak
      amplitudes in the channel's unit.
    - `/waterfall/<channel>`: all blocks (blocks, orders) in dB of the channel's largest amplitude, cut at FLOOR.

    A channel without blocks, or with amplitudes of zero alone, is left out.
    """
    for name, channel in spectrum_channels(replay).items():
        found = order_map(channel.values, replay.recording.sample_rate_hz, replay.pulse_times, most_blocks=MOST_BLOCKS)
        if not found.amplitude.size or not found.amplitude.any():
            continue
        left = found.order - found.order[0] / 2
        send_bars(stream, f"/spectrum/{name}", time_column(found.time), found.amplitude, left, rgba(BLUE))
        decibel = 20 * np.log10(np.maximum(found.amplitude / found.amplitude.max(), FLOOR))
        names = ["time", f"order 0 to {HIGHEST_ORDER}"]
        stream.log(f"/waterfall/{name}", rr.Tensor(decibel.astype(np.float16), dim_names=names), static=True)


class _Spectra:
    """Rows of values as the column of tensors that Rerun's bars need."""

    def __init__(self, rows: Float32Array) -> None:
        self.rows = rows

    def as_arrow_array(self) -> pa.Array:
        """Return one tensor a row."""
        return pa.concat_arrays([rr.components.TensorDataBatch(row).as_arrow_array() for row in self.rows])


def send_bars(
    stream: rr.RecordingStream,
    entity: str,
    index: list[rr.TimeColumn],
    values: FloatArray,
    left: FloatArray,
    color: int,
) -> None:
    """Send bars of equal width whose heights change over time.

    - stream, entity: recording, and path of the bars in it.
    - index: times of the rows.
    - values (rows, n): heights at each time; at least one row.
    - left (n,): left edges, at equal steps; a single bar has the width 1.
    - color: colour of all bars.
    """
    width = np.full(left.size, left[1] - left[0] if left.size > 1 else 1.0)
    whole = rr.BarChart(values[0], abscissa=left, widths=width, color=color).as_component_batches()
    heights = [batch for batch in whole if str(batch.component_descriptor()).endswith(":values")]
    stream.log(entity, [batch for batch in whole if batch not in heights], static=True)
    column = rr.ComponentColumn(heights[0].component_descriptor(), _Spectra(values.astype(np.float32)))
    stream.send_columns(entity, index, [column])
