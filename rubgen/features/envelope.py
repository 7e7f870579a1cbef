"""Features of the envelope of a signal in bands of frequency."""

from __future__ import annotations

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

    The envelope is the magnitude of the analytic signal in the band. Pulses are as in `by_turn`.
    """
    samples = signals.shape[1]
    faded = (signals - signals.mean(axis=1, keepdims=True)) * tukey(samples, 2 * ENDS)
    spectrum = fft.rfft(faded, axis=1)
    parts = [_of_band(spectrum, band, rate_hz, samples, pulses) for band in bands(rate_hz)]
    return np.concatenate(parts, axis=1) if parts else np.zeros((len(signals), 0))


def _of_band(
    spectrum: ComplexArray, band: tuple[int, int], rate_hz: float, samples: int, pulses: FloatArray
) -> FloatArray:
    seconds = samples / rate_hz
    first, last = (round(edge * seconds) for edge in band)
    size = fft.next_fast_len(DENSITY * (last - first))
    every = np.abs(fft.ifft(spectrum[:, first:last], n=size, axis=1)) * (2 * size / samples)
    rate, end = size / seconds, int(np.ceil(ENDS * size))
    envelope = every[:, end : size - end]
    mean = envelope.mean(axis=1, keepdims=True)
    square = (envelope - mean) ** 2
    variance = square.mean(axis=1)
    kurtosis = (square * square).mean(axis=1) / np.where(variance > 0, variance, np.nan) ** 2
    turned = by_turn(envelope, rate, pulses - end / rate)
    amplitudes = [2 * np.abs(circles(turned, order)) for order in ENVELOPE_ORDERS]
    impacts = _impacts(envelope, within(pulses - end / rate, envelope.shape[1], rate) * rate)
    return np.column_stack([mean[:, 0], np.sqrt(variance), envelope.max(axis=1), kurtosis, *amplitudes, impacts])


def _impacts(envelope: FloatArray, pulses: FloatArray) -> FloatArray:
    """Count the impacts in a turn: maxima of envelopes (channels, samples) that are as high as TIMES and SHARE say.

    Pulses are in samples. Without two of them the counts are NaN.
    """
    if pulses.size < 2:
        return np.full(len(envelope), np.nan)
    level = np.maximum(TIMES * np.median(envelope, axis=1), SHARE * envelope.max(axis=1))
    middle = envelope[:, 1:-1]
    high = (middle > envelope[:, :-2]) & (middle >= envelope[:, 2:]) & (middle > level[:, None])
    counted = high[:, int(pulses[0]) : int(pulses[-1])]
    return np.asarray(counted.sum(axis=1) / (pulses.size - 1))
