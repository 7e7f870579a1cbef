"""Features of the envelope of a signal in bands of frequency."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy import fft
from scipy.signal.windows import tukey

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.features.turns import by_turn, circles, within
from rubgen.features.vocabulary import ENVELOPE_ORDERS, bands

DENSITY = 3
"""Samples of the envelope for each that its band needs: a maximum between two of them is low by less than 5 %."""
ENDS = 0.03
"""Share of a window at each end that fades out and is not used: the two ends do not fit each other."""
TIMES, SHARE = 3.3, 0.25
"""An impact is above so many times the median, and above this share of the maximum. The ringing of the band's edges
stays below 0.22 of the maximum."""


def envelope_features(signals: FloatArray, rate_hz: float, pulses: FloatArray) -> FloatArray:
    """Compute the features `vocabulary.envelope` of signals (channels, samples), as (channels, features).

    The envelope is the magnitude of the analytic signal in a band of frequency. `rate_hz` is the sample rate. `pulses`
    are the times of the once_per_rev pulses in s from the first sample. The share ENDS of the signal at each end is not
    used. Without two pulses in the rest, impacts and amplitudes at orders are NaN. At a rate without any band the
    result is (channels, 0).
    """
    samples = signals.shape[1]
    faded = signals - signals.mean(axis=1, keepdims=True)
    faded *= _fade(samples)
    spectrum = fft.rfft(faded, axis=1)
    parts = [_of_band(spectrum, band, rate_hz, samples, pulses) for band in bands(rate_hz)]
    return np.concatenate(parts, axis=1) if parts else np.zeros((len(signals), 0))


def _of_band(
    spectrum: ComplexArray, band: tuple[int, int], rate_hz: float, samples: int, pulses: FloatArray
) -> FloatArray:
    seconds = samples / rate_hz
    first, last = (round(edge * seconds) for edge in band)
    size = fft.next_fast_len(DENSITY * (last - first))
    every = np.abs(fft.ifft(spectrum[:, first:last], n=size, axis=1))
    every *= 2 * size / samples
    rate, end = size / seconds, int(np.ceil(ENDS * size))
    envelopes, pulses = every[:, end : size - end], pulses - end / rate
    inside = within(pulses, envelopes.shape[1], rate) * rate
    found = np.array([[*_of_one(row), _impacts(row, inside)] for row in envelopes])
    amplitudes = 2 * np.abs(circles(by_turn(envelopes, rate, pulses), ENVELOPE_ORDERS))
    return np.column_stack([found[:, :-1], *amplitudes, found[:, -1]])


@lru_cache(maxsize=2)
def _fade(samples: int) -> FloatArray:
    return np.asarray(tukey(samples, 2 * ENDS))


def _of_one(envelope: FloatArray) -> list[float]:
    """Return mean, rms without it, maximum and kurtosis of an envelope (samples,)."""
    mean = float(envelope.mean())
    square = (envelope - mean) ** 2
    variance = float(square.mean())
    kurtosis = float(square @ square) / square.size / (variance**2 or np.nan)
    return [mean, variance**0.5, float(envelope.max()), kurtosis]


def _impacts(envelope: FloatArray, pulses: FloatArray) -> float:
    """Count the impacts in a turn: maxima of an envelope (samples,) that are as high as TIMES and SHARE say.

    Pulses are in samples. Without two of them the count is NaN.
    """
    if pulses.size < 2:
        return np.nan
    level = max(TIMES * _median(envelope), SHARE * envelope.max())
    middle = envelope[1:-1]
    high = (middle > envelope[:-2]) & (middle >= envelope[2:]) & (middle > level)
    return np.count_nonzero(high[int(pulses[0]) : int(pulses[-1])]) / (pulses.size - 1)


def _median(values: FloatArray) -> float:
    """Return the median of values (any,). It takes a quarter of the time of np.median, which partitions twice."""
    half = values.size // 2
    ordered = np.partition(values, half)
    return float(ordered[half] if values.size % 2 else (ordered[:half].max() + ordered[half]) / 2)
