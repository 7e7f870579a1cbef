"""The measuring chain of every channel: anti-alias filter and resampling, range and ADC."""

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.machine.frame import Frame
from rubgen.measurement.front_end import memory_seconds
from rubgen.scenario import Sensing

PASS_BAND_SHARE = 2 / 2.56
"""End of the pass band as a share of the Nyquist frequency: sample rate / 2.56, as in dynamic signal analysers."""
ATTENUATION_DB = 90.0
"""Design attenuation of the Kaiser window. At and above the Nyquist frequency it is at least 85 dB."""
KAISER_BETA = 0.1102 * (ATTENUATION_DB - 8.7)
"""Kaiser's formula for attenuations above 50 dB (Kaiser 1974)."""
PHASES = 512
"""Positions between two steps for which weights are tabulated. With linear interpolation their error is below -109 dB,
even with the fewest steps."""
SAMPLES_AT_ONCE = 512
"""Samples that are filtered together: the steps that they need stay in the second cache."""


def half_width_seconds(sample_rate_hz: float) -> float:
    """Return half the length of the anti-alias filter for a sample rate, in s.

    Kaiser's formula (Kaiser 1974): length = (A - 7.95) / (2.285 * 2 pi * transition width in Hz).
    """
    transition_hz = sample_rate_hz / 2 * (1 - PASS_BAND_SHARE)
    return float((ATTENUATION_DB - 7.95) / (2.285 * 2 * np.pi * transition_hz) / 2)


def late_seconds(sensing: Sensing, seconds: float, *, sign: int = 1) -> float:
    """Return how late, in s, the latest sensor clock of the set takes a sample within `seconds`; at least 0.

    With `sign` = -1 it is how early the earliest clock takes a sample.
    """
    clocks = [(each.clock_offset_s, 1e-6 * each.clock_ppm * seconds) for each in sensing.set.sampled]
    return max([0.0, *(sign * (offset + share * slow) for offset, slow in clocks for share in (0, 1))])


def start_seconds(sensing: Sensing, seconds: float, *, steps: int, dt: float) -> float:
    """Return the time of the first sample, in s from the start of the record; negative where the record is too short.

    It is the time for a sensor without clock errors. The last of round(`seconds` * sample rate) samples, as the latest
    clock takes it, is half the length of the anti-alias filter before the last step.

    - sensing: sample rate, and the clocks of the sensors.
    - seconds: length of the recording.
    - steps: number of steps of the record.
    - dt: time step, s.
    """
    rate = sensing.sample_rate_hz
    end = (steps - 1) * dt - half_width_seconds(rate)
    return float(end - (late_seconds(sensing, seconds) + (round(seconds * rate) - 1) / rate))


def margin_seconds(sensing: Sensing, seconds: float = 0.0, frame: Frame | None = None) -> float:
    """Return the length of signal in s that a recording of `seconds` needs in addition to `seconds`.

    It is the sum of:

    - half the length of the anti-alias filter on either side,
    - the longest decay time of a sensor's own filters (`memory_seconds`),
    - the decay time of the machine's `frame` (`Frame.memory_seconds`); None is no frame,
    - how far the clocks of sensors are early and late within `seconds`,
    - two sample periods, for rounding to whole steps and samples.
    """
    margin = 2 * half_width_seconds(sensing.sample_rate_hz) + 2 / sensing.sample_rate_hz
    margin += max((memory_seconds(each) for each in sensing.set.sampled), default=0.0)
    margin += frame.memory_seconds if frame else 0.0
    return margin + late_seconds(sensing, seconds) + late_seconds(sensing, seconds, sign=-1)


def impulse_response(time: FloatArray, sample_rate_hz: float) -> FloatArray:
    """Return h(t) of the anti-alias filter in 1/s at each `time` in s, an array of any shape.

    A sinc with a Kaiser window: h(t) = 2 f_c sinc(2 f_c t) I0(beta sqrt(1 - (t/W)^2)) / I0(beta) for |t| < W, else 0.
    The cut-off frequency f_c is midway between the end of the pass band and the Nyquist frequency. W is
    `half_width_seconds`, beta KAISER_BETA. h is even, so the filter has no delay.
    """
    half_width = half_width_seconds(sample_rate_hz)
    cut_off = sample_rate_hz / 4 * (1 + PASS_BAND_SHARE)
    inside = 1 - (time / half_width) ** 2
    window = np.i0(KAISER_BETA * np.sqrt(np.maximum(inside, 0.0))) / np.i0(KAISER_BETA)
    return np.asarray(2 * cut_off * np.sinc(2 * cut_off * time) * window * (inside > 0), dtype=np.float64)


@lru_cache(maxsize=4)
def filter_bank(dt: float, sample_rate_hz: float) -> FloatArray:
    """Tabulate the filter's weights (PHASES + 1, 2 half) for positions between two steps of `dt` s. Rows sum to 1.

    The array is read-only. A row is a position, from the first of the two steps to the second. A column is a step, and
    the two steps are columns half - 1 and half.
    """
    half = int(np.ceil(half_width_seconds(sample_rate_hz) / dt))
    phase = np.linspace(0.0, 1.0, PHASES + 1)[:, None]
    steps = np.arange(-half + 1, half + 1)[None, :]
    half_bank = impulse_response((phase[: PHASES // 2 + 1] - steps) * dt, sample_rate_hz)
    bank = np.concatenate([half_bank, half_bank[-2::-1, ::-1]])  # h is even: the other half is the mirrored one
    bank /= bank.sum(axis=1, keepdims=True)
    bank.setflags(write=False)
    return bank


def band_limit(signals: Sequence[FloatArray], positions: FloatArray, *, dt: float, sample_rate_hz: float) -> FloatArray:
    """Return band-limited signals (samples, channels) at fractional step positions.

    Filter and interpolation in one: y(t) = sum_j h(t - j dt) x_j dt, with the weights' sum set to 1. The gain is 1
    within 1e-4 up to sample_rate / 2.56 and below 1e-4 from sample_rate / 2 on. There is no delay. The step rate must
    be at least 2.56 sample rates, and all positions at least half a filter length from the ends of the signals. The
    caller ensures both.

    - signals: one of each channel, each (steps,) with values at every step.
    - positions (samples,): times of the samples, in steps from the first step; at least one.
    - dt: time step, s.
    - sample_rate_hz: sample rate.
    """
    from rubgen.measurement.resampling_kernels import (  # compiled: those who read data need no numba
        ABREAST,
        interpolate_rows,
    )

    bank = filter_bank(dt, sample_rate_hz)
    before, after = 1 - bank.shape[1] // 2, 1 + bank.shape[1] // 2
    parts = [slice(sample, sample + SAMPLES_AT_ONCE) for sample in range(0, positions.size, SAMPLES_AT_ONCE)]
    spans = [(math.floor(at.min()) + before, math.floor(at.max()) + after) for at in map(positions.__getitem__, parts)]
    room = np.zeros((max(end - first for first, end in spans), ABREAST))
    out = np.empty((positions.size, len(signals)))
    for start in range(0, len(signals), ABREAST):
        abreast, filtered = signals[start : start + ABREAST], np.zeros((positions.size, ABREAST))
        for part, (first, end) in zip(parts, spans, strict=True):
            for column, signal in enumerate(abreast):
                room[: end - first, column] = signal[first:end]
            interpolate_rows(room, bank, positions[part] - first, filtered[part])  # the difference is exact
        out[:, start : start + ABREAST] = filtered[:, : len(abreast)]
    return out


def adc_step(range_min: float, range_max: float, bits: int) -> float:
    """Return the size of one ADC step: the range divided by 2^bits, in the unit of the range."""
    return float((range_max - range_min) / 2**bits)


def digitise(signal: FloatArray, *, range_min: float, range_max: float, bits: int) -> FloatArray:
    """Return the signal after the ADC: clipped to its range, rounded to range_min + code * step, code 0 .. 2^bits - 1.

    The highest value is one step below range_max. float32 has at most 24 bits: finer steps are lost in files.
    """
    step = adc_step(range_min, range_max, bits)
    code = np.clip(np.rint((signal - range_min) / step), 0, 2**bits - 1)
    return np.asarray(range_min + code * step, dtype=np.float64)
