"""Cut signals into windows: of equal time, or of equal angle between the pulses of the shaft."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from numbers import Real

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.errors import UserError
from rubgen.measurement.channel import Float32Array

SAMPLES_PER_TURN = 256
"""Samples of a turn in a window of turns: orders up to 128 show. At 25,600 Hz a turn has fewer above 6,000 rev/min."""


@dataclass(frozen=True)
class Cut:
    """Windows of `length` that start every `hop`, both in samples, or both in turns where `turns` is True."""

    length: int
    hop: int
    turns: bool
    rate: float
    """Samples per second."""
    text: str
    """The length as the user gave it, for messages."""

    @property
    def samples(self) -> int:
        """Number of samples of a window."""
        return self.length * SAMPLES_PER_TURN if self.turns else self.length

    def pieces(self, pulses: FloatArray, count: int) -> FloatArray:
        """Return start and end of each window (windows, 2), in s from the first sample. A rest at the end is left out.

        Windows of turns begin and end at pulses, the first at the first pulse.

        - pulses: times of the run's once_per_rev pulses in s.
        - count: number of samples of the run.
        """
        places = pulses[pulses <= (count - 1) / self.rate] if self.turns else np.arange(count + 1) / self.rate
        first = np.arange(0, max(len(places) - self.length, 0), self.hop)
        return np.column_stack([places[first], places[first + self.length]])

    def cutter(self, signals: Float32Array, pulses: FloatArray) -> Callable[[float], Float32Array]:
        """Return a function that cuts a window (channels, samples) out of a run's signals.

        The function takes the start of the window in s, which must be a start in `pieces`. A window of equal time is a
        view of `signals`.

        - signals (channels, count): the channels of the run.
        - pulses: times of the run's once_per_rev pulses in s.

        Windows of turns have SAMPLES_PER_TURN values a turn at equal angles, as in computed order tracking: a monotone
        cubic goes through the times of the pulses, and a cubic spline through the samples.
        """
        if not self.turns:
            return lambda start: signals[:, round(start * self.rate) : round(start * self.rate) + self.length]
        from scipy.interpolate import PchipInterpolator, make_interp_spline

        spline = make_interp_spline(np.arange(signals.shape[1]) / self.rate, signals, k=3, axis=1)
        time_of = PchipInterpolator(np.arange(pulses.size), pulses)
        part = np.arange(self.samples) / SAMPLES_PER_TURN
        return lambda start: np.asarray(spline(time_of(np.searchsorted(pulses, start) + part)), dtype=np.float32)

    def advice(self, count: int) -> str:
        """Return a clause for messages that says how long signals of `count` samples last."""
        return f"signals last {count / self.rate:g} s; give less"


def cut_of(seconds: float | None, turns: int | None, hop: float | None, rate: float, *, tacho: bool) -> Cut:
    """Return how to cut signals: into windows of `seconds`, or of `turns`, every `hop`.

    - seconds: length of a window, rounded to whole samples.
    - hop: distance of the starts, in the same unit and rounded in the same way; None is the length of a window.
    - rate: samples per second.
    - tacho: whether the set has a once_per_rev sensor.

    Raises UserError where not exactly one length is given, a length or hop is not positive, rounds to no sample or is
    no whole number of turns, or `turns` is given without a tacho.
    """
    if (seconds is None) == (turns is None):
        raise UserError("windows: give their length either in seconds or in turns")
    if turns is not None:
        return _turns(turns, hop, rate, tacho=tacho)
    length = _positive("seconds", seconds)
    step = length if hop is None else _positive("hop", hop)
    for key, value in (("seconds", length), ("hop", step)):
        if round(value * rate) < 1:
            raise UserError(f"{key} = {value:g}: shorter than a sample, which lasts {1 / rate:g} s; give more")
    return Cut(round(length * rate), round(step * rate), turns=False, rate=rate, text=f"seconds = {length:g}")


def _turns(turns: float, hop: float | None, rate: float, *, tacho: bool) -> Cut:
    if not tacho:
        raise UserError(f"turns = {turns}: the set has no once_per_rev sensor, whose pulses turns need; give seconds")
    values = {"turns": _positive("turns", turns), "hop": _positive("hop", turns if hop is None else hop)}
    for key, value in values.items():
        if value != int(value):
            raise UserError(f"{key} = {value:g}: turns are whole numbers; give {max(round(value), 1)}")
    return Cut(int(values["turns"]), int(values["hop"]), turns=True, rate=rate, text=f"turns = {turns:g}")


def _positive(key: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, Real) or not 0 < float(value) < float("inf"):
        raise UserError(f"{key} = {value!r:.60}: must be a number above 0")
    return float(value)
