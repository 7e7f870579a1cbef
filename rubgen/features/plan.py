"""What to compute of a data set: channels, sets of features, windows; and the columns that follow from it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from math import radians, sin

import pyarrow as pa

from rubgen.dataset.reading.open import DataSet
from rubgen.errors import UserError
from rubgen.features.vocabulary import GENERIC, NEED_PULSES, ORBIT, SAME, SETS, Feature, of_channel
from rubgen.features.windows import Window, parse_window
from rubgen.machine.problems import nearest
from rubgen.sensors.kinds.once_per_rev import OncePerRev
from rubgen.sensors.kinds.proximity import Proximity
from rubgen.sensors.sensor_set import SensorSet

NEVER_PARALLEL = 0.2
"""Least sine of the angle between two probes of an orbit: below it, noise of the probes is five times larger."""
IDS = (
    ("run_id", pa.string(), "", "name of the run"),
    ("machine_id", pa.string(), "", "machine of the run; splits never share one"),
    ("split", pa.string(), "", "split of the data set"),
    ("window", pa.int64(), "", "number of the window in the run, from 0"),
    ("start_s", pa.float64(), "s", "time of the window's first sample from the first sample of the run's signals"),
    ("seconds", pa.float64(), "s", "length of the window"),
)
"""The first columns: name, type, unit, meaning."""


@dataclass(frozen=True)
class Plan:
    """What is computed for every run of a set: channels, sets of features, windows."""

    channels: tuple[str, ...]
    sets: tuple[str, ...]
    window: Window | None
    """None is the whole signal."""
    rate_hz: float
    pairs: tuple[tuple[str, str, float, float], ...]
    """Two shaft probes of each orbit with their angles in degrees."""
    units: tuple[str, ...]
    """Of the channels."""
    generic: tuple[str, ...]
    """Names of the features of tsfel, as long as the windows have one length."""

    @property
    def each(self) -> tuple[Feature, ...]:
        """Features of one channel that rubgen computes itself."""
        return of_channel(self.sets, self.rate_hz)

    def schema(self) -> pa.Schema:
        """Return the Arrow schema of the table. The metadata of a field has its unit and meaning."""
        fields = [_field(name, kind, unit, meaning) for name, kind, unit, meaning in IDS]
        for channel, unit in zip(self.channels, self.units, strict=True):
            fields += [_feature(channel, each, unit) for each in self.each]
            fields += [_feature(channel, Feature(name, "", "as tsfel defines it"), unit) for name in self.generic]
        for first, second, *_ in self.pairs:
            unit = self.units[self.channels.index(first)]
            fields += [_feature(f"{first}_{second}", each, unit) for each in ORBIT]
        return pa.schema(fields)


def make_plan(data: DataSet, window: str | None, channels: Sequence[str] | None, sets: Sequence[str] | None) -> Plan:
    """Make the plan for a data set, and check it.

    - window: length such as "0.25s" or "16turns"; None is the whole signal.
    - channels: names; None takes all channels that a sensor could record.
    - sets: time, order, envelope, orbit or tsfel; None takes all but tsfel that are possible.

    Raises UserError for an unknown channel, set or window, and for features that need a pulse or a pair of shaft probes
    that the data set does not have. Whether tsfel is installed is not checked.
    """
    root, sensors, rate = data.layout.root, data.sensors, data.sample_rate_hz
    names = _channels(data, channels)
    has_pulses = any(isinstance(sensor, OncePerRev) for sensor in sensors.sensors)
    pairs = shaft_pairs(sensors, names)
    possible = [name for name in SETS if (has_pulses or name not in NEED_PULSES) and (pairs or name != "orbit")]
    chosen = _sets(sets) if sets else possible
    needing = [name for name in chosen if name in NEED_PULSES]
    length = parse_window(window, rate) if window else None
    if length and length.unit == "turns":
        needing.append(f"--window {window}")
    if needing and not has_pulses:
        raise UserError(f"{root}: {needing[0]} needs pulses, and the set has no sensor once_per_rev; give --set time")
    if "orbit" in chosen and not pairs:
        raise UserError(f"{root}: orbit needs two proximity probes across each other among the channels; leave it out")
    ordered = tuple(name for name in (*SETS, GENERIC) if name in chosen)
    units = tuple(data.units[name] for name in names)
    return Plan(names, ordered, length, rate, pairs if "orbit" in chosen else (), units, ())


def _channels(data: DataSet, channels: Sequence[str] | None) -> tuple[str, ...]:
    if channels is None:
        return tuple(sensor.name for sensor in data.sensors.sampled if sensor.name in data.inputs)
    names = [sensor.name for sensor in data.sensors.sampled]
    for name in channels:
        if name not in names:
            raise UserError(f"{data.layout.root}: no recorded channel {name!r:.60}; {nearest(name, names)}")
    return tuple(dict.fromkeys(channels))


def _sets(sets: Sequence[str]) -> list[str]:
    for name in sets:
        if name not in (*SETS, GENERIC):
            raise UserError(f"--set {name!r:.60}: unknown set of features; {nearest(name, [*SETS, GENERIC])}")
    return list(sets)


def shaft_pairs(sensors: SensorSet, channels: Sequence[str]) -> tuple[tuple[str, str, float, float], ...]:
    """Return the first two shaft probes that can show an orbit, with their angles in degrees.

    The pair is the first in the order of the sensor set whose probes are in `channels`, have the same unit, and have an
    angle between them whose sine is above NEVER_PARALLEL. The result has one pair, or is empty without such a pair.
    """
    probes = [each for each in sensors.sampled if isinstance(each, Proximity) and each.name in channels]
    for a, b in combinations(probes, 2):
        if a.unit == b.unit and abs(sin(radians(b.angle_deg - a.angle_deg))) > NEVER_PARALLEL:
            return ((a.name, b.name, a.angle_deg, b.angle_deg),)
    return ()


def _feature(start: str, feature: Feature, unit: str) -> pa.Field:
    own = unit if feature.unit == SAME else feature.unit
    return _field(f"{start}__{feature.name}", pa.float64(), own, feature.meaning)


def _field(name: str, kind: pa.DataType, unit: str, meaning: str) -> pa.Field:
    return pa.field(name, kind, metadata={"unit": unit, "meaning": meaning})
