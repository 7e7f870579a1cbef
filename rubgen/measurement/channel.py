"""The record of a virtual sensor, and a preview of it in equal bins with every spike."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray, IntArray
from rubgen.brief import brief
from rubgen.measurement.blade_tip_timing import TipTimes

Float32Array = npt.NDArray[np.float32]
PREVIEW_RATE_HZ = 1024.0


@dataclass(frozen=True, kw_only=True)
class Channel:
    """One recorded signal with its description. `values` (n_samples,) are in `unit`, at the recording's sample rate.

    `clean` is the signal of an ideal sensor, or None. `range_min`, `range_max`, `resolution` (one ADC step) and
    `noise_rms` are in `unit` too.
    """

    name: str
    unit: str
    quantity: str
    axis: str
    location: str
    range_min: float
    range_max: float
    resolution: float
    noise_rms: float
    values: Float32Array
    clean: Float32Array | None = None

    __repr__ = brief


TEXTS, NUMBERS = ("unit", "quantity", "axis", "location"), ("range_min", "range_max", "resolution", "noise_rms")
"""Fields of a channel that files keep beside its samples."""


def quantity_key(quantity: str) -> str:
    """Return a quantity as it is written in topics and entity paths: with "_" in place of blanks."""
    return quantity.replace(" ", "_")


@dataclass(frozen=True, kw_only=True)
class Recording:
    """All channels of one run, over the end of its record. Sample i is at time i / sample_rate_hz."""

    sample_rate_hz: float
    """Sample rate of all channels."""
    rotation_angle: float
    """Angle theta of the blisk at the first sample, in [0, 2 pi)."""
    channels: dict[str, Channel]
    """Channels by name."""
    once_per_rev: FloatArray
    """Times in s at which theta passes 0 mod 2 pi (n_pulses,), as recorded by the sensor of that kind; exact without
    one."""
    start_seconds: float = 0.0
    """Time of the first sample from the start of the record."""
    tip_timing: dict[str, TipTimes] = field(default_factory=dict)
    """Record of each timing probe by its name."""

    __repr__ = brief

    @property
    def samples(self) -> int:
        """Number of samples of every channel."""
        return next(iter(self.channels.values())).values.size

    def by_quantity(self) -> dict[str, list[Channel]]:
        """Group the channels by quantity and unit. Groups and channels are in the order of the recording.

        The key of a group is its quantity, with "_" for blanks. Where channels of a quantity have several units, only
        the group of the first unit has this key. The key of each other group is `<quantity>_in_<unit>`, with "_per_"
        for "/".
        """
        groups: dict[str, list[Channel]] = {}
        for channel in self.channels.values():
            key = quantity_key(channel.quantity)
            if key in groups and groups[key][0].unit != channel.unit:
                key = quantity_key(f"{channel.quantity} in {channel.unit.replace('/', ' per ')}")
            groups.setdefault(key, []).append(channel)
        return groups


@dataclass(frozen=True, kw_only=True)
class Preview:
    """Minimum and maximum of channels in equal bins: `values` (bins, columns) in their unit.

    Bin i begins at sample `first[i]`. Each channel has two columns, `<channel>.min` and `<channel>.max`, as in `names`.
    """

    names: tuple[str, ...]
    first: IntArray
    values: FloatArray


def preview(channels: Sequence[Channel], sample_rate_hz: float, rate_hz: float = PREVIEW_RATE_HZ) -> Preview:
    """Compute minimum and maximum of channels in equal bins.

    - channels: at least one, all of the same length, in the order of the columns.
    - sample_rate_hz: sample rate of the channels.
    - rate_hz: approximate number of bins a second. A bin has a whole number of samples, at least one; the last bin may
      have fewer than the others.
    """
    samples_per_bin = max(1, round(sample_rate_hz / rate_hz))
    ends = [end for channel in channels for end in min_max(channel.values, samples_per_bin)]
    return Preview(
        names=tuple(f"{channel.name}.{end}" for channel in channels for end in ("min", "max")),
        first=np.arange(0, channels[0].values.size, samples_per_bin),
        values=np.column_stack(ends).astype(np.float64),
    )


def min_max(values: Float32Array, samples_per_bin: int) -> tuple[Float32Array, Float32Array]:
    """Compute minima and maxima of `values` (n,) in bins of `samples_per_bin`, each (ceil(n / samples_per_bin),).

    The last bin may have fewer samples. For empty `values` both are empty.
    """
    if values.size == 0:
        return values.copy(), values.copy()
    starts = np.arange(0, values.size, samples_per_bin)
    return np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
