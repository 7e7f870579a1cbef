"""What happens to a signal before the anti-alias filter: the sensor's own dynamics and its saturation."""

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.sensors.sensor import SampledSensor

FORGOTTEN = np.log(1e4)
"""A filter's start has died to 1e-4 after so many time constants."""


def resonance(frequency_hz: float, damping: float, dt: float) -> tuple[FloatArray, FloatArray]:
    """Digital filter b, a of a seismic mass on its mounting, w^2 / (s^2 + 2 d w s + w^2), exact at its resonance.

    Below it the gain rises as 1 / (1 - (f / f_r)^2), as it does in a data sheet (ISO 5348, mounted resonance). Bilinear
    with the frequency prewarped; 2.56 steps a period at least.
    """
    from scipy.signal import bilinear  # slow to import, and only needed where a sensor has dynamics

    w = 2 / dt * np.tan(np.pi * frequency_hz * dt)
    b, a = bilinear([w**2], [1.0, 2 * damping * w, w**2], fs=1 / dt)
    return np.asarray(b), np.asarray(a)


def front_end(sensor: SampledSensor, signal: FloatArray, dt: float) -> FloatArray:
    """The signal (steps,) behind bandwidth, resonance and saturation; the filters start at rest on its first value."""
    if sensor.bandwidth_hz is not None or sensor.resonance_hz is not None:
        signal = _behind_filters(sensor, signal, dt)
    if sensor.saturation is not None:
        signal = np.clip(signal, *sensor.saturation)
    return np.asarray(signal, dtype=np.float64)


def _behind_filters(sensor: SampledSensor, signal: FloatArray, dt: float) -> FloatArray:
    from scipy.signal import butter, lfilter, lfilter_zi  # slow to import

    filters = []
    if sensor.bandwidth_hz is not None:
        filters.append(butter(2, sensor.bandwidth_hz, fs=1 / dt))
    if sensor.resonance_hz is not None:
        filters.append(resonance(sensor.resonance_hz, sensor.resonance_damping, dt))
    for b, a in filters:
        signal, _ = lfilter(b, a, signal, zi=lfilter_zi(b, a) * signal[0])
    return signal


def memory_seconds(sensor: SampledSensor) -> float:
    """How long the sensor's filters remember, in s: what the signal must have before the first sample."""
    seconds = 0.0
    if sensor.bandwidth_hz is not None:
        seconds += float(FORGOTTEN / (2 * np.pi * sensor.bandwidth_hz * np.sqrt(0.5)))
    if sensor.resonance_hz is not None:
        seconds += float(FORGOTTEN / (2 * np.pi * sensor.resonance_hz * sensor.resonance_damping))
    return seconds
