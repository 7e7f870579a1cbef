"""Apply dynamics and saturation of a sensor before the anti-alias filter, and its errors after it."""

from functools import lru_cache

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.sensors.sensor import SampledSensor

FORGOTTEN = np.log(1e4)
"""Number of time constants after which a filter's start has decayed to 1e-4."""


def resonance(frequency_hz: float, damping: float, dt: float) -> tuple[FloatArray, FloatArray]:
    """Return the digital filter b, a of a seismic mass on its mounting, w^2 / (s^2 + 2 d w s + w^2).

    Bilinear, with the frequency prewarped: exact only at its resonance. With many steps a period, the gain below it
    rises as 1 / (1 - (f / f_r)^2), as in data sheets (ISO 5348, mounted resonance). With few it rises less: with 2.56
    steps it is 1.07 instead of 1.33 at f_r / 2. The caller ensures at least 2.56 steps a period.

    - frequency_hz: frequency f_r of the resonance.
    - damping: damping ratio d.
    - dt: time step, s.
    """
    from scipy.signal import bilinear  # slow to import, and only needed where a sensor has dynamics

    w = 2 / dt * np.tan(np.pi * frequency_hz * dt)
    b, a = bilinear([w**2], [1.0, 2 * damping * w, w**2], fs=1 / dt)
    return np.asarray(b), np.asarray(a)


def front_end(sensor: SampledSensor, signal: FloatArray, dt: float) -> FloatArray:
    """Return the signal (steps,) after bandwidth, then resonance, then saturation of a sensor, in the sensor's unit.

    The bandwidth is a Butterworth low-pass of second order. The filters start in equilibrium with the first value. A
    sensor without these properties returns the signal unchanged. `dt` is the time step in s.
    """
    if sensor.bandwidth_hz is not None or sensor.resonance_hz is not None:
        signal = _behind_filters(sensor, signal, dt)
    if sensor.saturation is not None:
        signal = np.clip(signal, *sensor.saturation)
    return np.asarray(signal, dtype=np.float64)


def _behind_filters(sensor: SampledSensor, signal: FloatArray, dt: float) -> FloatArray:
    from scipy.signal import lfilter  # slow to import

    for b, a, start in _filters(sensor.bandwidth_hz, sensor.resonance_hz, sensor.resonance_damping, dt):
        signal, _ = lfilter(b, a, signal, zi=start * signal[0])
    return signal


@lru_cache(maxsize=16)  # sensors of one kind share them, and to design one takes as long as to apply it
def _filters(
    bandwidth_hz: float | None, resonance_hz: float | None, damping: float, dt: float
) -> list[tuple[FloatArray, FloatArray, FloatArray]]:
    """Return b, a of each filter and its state in equilibrium with a signal of 1."""
    from scipy.signal import butter, lfilter_zi  # slow to import

    filters = []
    if bandwidth_hz is not None:
        filters.append(butter(2, bandwidth_hz, fs=1 / dt))
    if resonance_hz is not None:
        filters.append(resonance(resonance_hz, damping, dt))
    return [(b, a, lfilter_zi(b, a)) for b, a in filters]


def memory_seconds(sensor: SampledSensor) -> float:
    """Return the decay time of the sensor's filters in s: the length of signal needed before the first sample.

    It is the time in which the start of a filter decays to 1e-4, summed over bandwidth and resonance. It is 0 for a
    sensor without filters.
    """
    seconds = 0.0
    if sensor.bandwidth_hz is not None:
        seconds += float(FORGOTTEN / (2 * np.pi * sensor.bandwidth_hz * np.sqrt(0.5)))
    if sensor.resonance_hz is not None:
        seconds += float(FORGOTTEN / (2 * np.pi * sensor.resonance_hz * sensor.resonance_damping))
    return seconds


def miscalibrate(sensor: SampledSensor, signal: FloatArray, *, zero: float, sample_rate_hz: float) -> FloatArray:
    """Return zero + (1 + gain error) (x - zero) + offset + drift t, in the sensor's unit.

    - sensor: the sensor with its errors.
    - signal (samples,): x.
    - zero: reading of the sensor for the value 0 of the measured quantity.
    - sample_rate_hz: sample rate, from which t follows: s from the first sample.
    """
    if not (sensor.gain_error or sensor.offset or sensor.drift_per_s):
        return signal
    time = np.arange(signal.size) / sample_rate_hz
    scaled = zero + (1 + sensor.gain_error) * (signal - zero)
    return np.asarray(scaled + sensor.offset + sensor.drift_per_s * time)


def noise(
    sensor: SampledSensor, samples: int, sample_rate_hz: float, scale: float, rng: np.random.Generator
) -> FloatArray:
    """Draw the sum (samples,) of two Gaussian noises: a white one of the rms `noise_rms`, and a coloured one.

    The coloured one has the one-sided spectral density D^2 (1 + f_c / f) up to half the sample rate. D is
    `noise_density` per sqrt(Hz), f_c `noise_corner_hz`. It is white noise shaped in the frequency domain. Its mean is
    zero, and it repeats after the recording's length.

    - sensor: the sensor; its noise is in its unit.
    - samples: number of samples.
    - sample_rate_hz: sample rate.
    - scale: factor of both noises.
    - rng: random numbers.
    """
    total = scale * sensor.noise_rms * rng.standard_normal(samples)
    if sensor.noise_density > 0:
        shaped = np.fft.rfft(rng.standard_normal(samples)) * _shape(sensor, samples, sample_rate_hz)
        total = total + scale * np.fft.irfft(shaped, samples)
    return np.asarray(total)


def noise_level(sensor: SampledSensor, samples: int, sample_rate_hz: float) -> float:
    """Return the expected rms of `noise` with the scale 1, both noises together, in the sensor's unit.

    `samples` and `sample_rate_hz` are of the recording.
    """
    if sensor.noise_density == 0:
        return sensor.noise_rms
    shape = _shape(sensor, samples, sample_rate_hz)
    # Each frequency counts twice in the whole spectrum, except the first and, for an even number of samples, the last.
    whole = 2 * np.sum(shape**2) - shape[0] ** 2 - (shape[-1] ** 2 if samples % 2 == 0 else 0.0)
    return float(np.hypot(sensor.noise_rms, np.sqrt(whole / samples)))


def _shape(sensor: SampledSensor, samples: int, sample_rate_hz: float) -> FloatArray:
    """Return the gain at each frequency that turns white noise of rms 1 into noise of the sensor's density."""
    frequency = np.fft.rfftfreq(samples, 1 / sample_rate_hz)
    shape = np.zeros_like(frequency)
    shape[1:] = np.sqrt(1 + sensor.noise_corner_hz / frequency[1:])
    return np.asarray(sensor.noise_density * np.sqrt(sample_rate_hz / 2) * shape)


def drop_out(sensor: SampledSensor, values: FloatArray, sample_rate_hz: float, rng: np.random.Generator) -> FloatArray:
    """Replace samples in gaps at random times by the last sample before the gap. Return the samples (n,).

    The starts of the gaps are a Poisson process of the sensor's rate `dropouts_per_s`; each gap lasts `dropout_s`. The
    first sample is always kept.

    - sensor: the sensor.
    - values (n,): samples.
    - sample_rate_hz: sample rate.
    - rng: random numbers.
    """
    if sensor.dropouts_per_s == 0:
        return values
    seconds = values.size / sample_rate_hz
    starts = rng.uniform(0.0, seconds, rng.poisson(sensor.dropouts_per_s * seconds)) * sample_rate_hz
    good = np.ones(values.size, dtype=bool)
    for start in starts:
        good[int(np.ceil(start)) : int(np.ceil(start + sensor.dropout_s * sample_rate_hz))] = False
    good[0] = True
    return np.asarray(values[np.maximum.accumulate(np.where(good, np.arange(values.size), 0))])
