"""A sensor's own dynamics and the faults of its chain, each against what its formula says."""

import numpy as np
import pytest

from rubgen.measurement.front_end import drop_out, front_end, memory_seconds, miscalibrate, noise, noise_level
from rubgen.sensors.kinds.accelerometer import Accelerometer
from rubgen.sensors.kinds.proximity import Proximity

DT = 1 / 150_000
RATE = 25600.0


def accelerometer(**values):
    return Accelerometer(name="a", angle_deg=0, **values)


def gain(sensor, frequency):
    """Complex gain for a tone, once the start is forgotten."""
    steps = int(np.ceil(memory_seconds(sensor) / DT)) + round(40 / frequency / DT)
    time = DT * np.arange(steps)
    out = [front_end(sensor, wave(2 * np.pi * frequency * time), DT) for wave in (np.cos, np.sin)]
    return complex((out[0][-1] + 1j * out[1][-1]) * np.exp(-2j * np.pi * frequency * time[-1]))


@pytest.mark.parametrize("frequency", [500.0, 5e3, 12e3, 30e3])
def test_a_mounting_resonance_is_that_of_a_mass_on_a_spring(frequency):
    sensor = accelerometer(resonance_hz=30e3, resonance_damping=0.03)
    r = np.tan(np.pi * frequency * DT) / np.tan(np.pi * 30e3 * DT)  # the bilinear transform's own frequency
    assert gain(sensor, frequency) == pytest.approx(1 / (1 - r**2 + 2j * 0.03 * r), rel=2e-3)
    if frequency <= 5e3:  # far below the steps' rate it is near the analogue sensor's
        r = frequency / 30e3
        assert gain(sensor, frequency) == pytest.approx(1 / (1 - r**2 + 2j * 0.03 * r), abs=1e-2)


def test_bandwidth_is_where_three_decibel_are_lost():
    sensor = accelerometer(bandwidth_hz=8e3)
    assert abs(gain(sensor, 8e3)) == pytest.approx(np.sqrt(0.5), rel=1e-3)
    assert abs(gain(sensor, 100.0)) == pytest.approx(1, rel=1e-3)
    assert abs(gain(sensor, 16e3)) < 0.25


def test_a_resonance_rings_beyond_the_range_and_saturates_before_the_filter():
    sensor = accelerometer(resonance_hz=20e3, saturation=(-1.5, 1.2))
    step = np.concatenate([np.zeros(100), np.ones(400)])
    out = front_end(sensor, step, DT)
    assert out.max() == 1.2
    ringing = front_end(accelerometer(resonance_hz=20e3), step, DT)
    assert 1.8 < ringing.max() < 2.0  # the overshoot of a lightly damped mass
    assert np.all(ringing[:100] == 0)


def test_a_constant_passes_from_the_first_value_on():
    sensor = accelerometer(resonance_hz=20e3, bandwidth_hz=9e3)
    assert front_end(sensor, np.full(50, 7.5), DT) == pytest.approx(7.5, rel=1e-9)


def test_without_faults_nothing_is_touched():
    signal, rng = np.arange(5.0), np.random.default_rng(0)
    sensor = accelerometer()
    assert front_end(sensor, signal, DT) is signal
    assert miscalibrate(sensor, signal, zero=0.0, sample_rate_hz=RATE) is signal
    assert drop_out(sensor, signal, RATE, rng) is signal
    assert not noise(sensor, 5, RATE, 1.0, rng).any()


def test_gain_offset_and_drift_are_about_the_sensors_zero():
    sensor = Proximity(name="p", angle_deg=0, unit="V", gain_error=0.05, offset=0.2, drift_per_s=3.0)
    signal = np.array([-10.0, -8.0, -12.0])
    seen = miscalibrate(sensor, signal, zero=-10.0, sample_rate_hz=10.0)
    assert seen == pytest.approx([-10 + 0.2, -7.9 + 0.2 + 0.3, -12.1 + 0.2 + 0.6])


def test_noise_has_its_density_and_rises_as_one_over_f():
    sensor = accelerometer(noise_density=2e-3, noise_corner_hz=400.0)
    samples, rng = 2**16, np.random.default_rng(3)
    power = np.zeros(samples // 2 + 1)
    for _ in range(8):
        power += np.abs(np.fft.rfft(noise(sensor, samples, RATE, 1.0, rng))) ** 2 / 8
    density = power * 2 / (samples * RATE)  # one-sided
    frequency = np.fft.rfftfreq(samples, 1 / RATE)
    for low, high in ((20, 120), (350, 450), (5e3, 12e3)):
        band = (frequency > low) & (frequency < high)
        expected = 4e-6 * (1 + 400 / frequency[band])
        assert (density[band] / expected).mean() == pytest.approx(1, rel=0.06)


def test_the_stated_level_is_that_of_the_noise():
    sensor = accelerometer(noise_density=2e-3, noise_corner_hz=400.0, noise_rms=0.4)
    drawn = np.stack([noise(sensor, 4096, RATE, 1.0, np.random.default_rng(seed)) for seed in range(60)])
    assert drawn.std() == pytest.approx(noise_level(sensor, 4096, RATE), rel=0.01)
    assert not noise(sensor, 4096, RATE, 0.0, np.random.default_rng(0)).any()


@pytest.mark.parametrize("samples", [4, 5, 16, 17])
def test_the_level_is_the_sum_over_all_frequencies_of_an_even_or_odd_number_of_samples(samples):
    """Every frequency but 0, also the negative ones, has the density D^2 (1 + f_c / |f|) / 2 times RATE / samples."""
    sensor = accelerometer(noise_density=2e-3, noise_corner_hz=400.0)
    frequency = np.abs(np.fft.fftfreq(samples, 1 / RATE))[1:]
    power = np.sum(2e-3**2 * (1 + 400 / frequency) / 2) * RATE / samples
    assert noise_level(sensor, samples, RATE) == pytest.approx(np.sqrt(power), rel=1e-12)


def test_dropouts_hold_the_last_value_as_often_and_as_long_as_stated():
    sensor = accelerometer(dropouts_per_s=20.0, dropout_s=2e-3)
    signal = np.arange(20 * 25600.0)
    seen = drop_out(sensor, signal, RATE, np.random.default_rng(1))
    held = seen != signal
    starts = np.flatnonzero(held[1:] & ~held[:-1]) + 1
    assert starts.size == pytest.approx(20 * 20, abs=4 * np.sqrt(400))
    assert held.mean() == pytest.approx(1 - np.exp(-20 * 2e-3), rel=0.2)  # gaps may overlap
    for start in starts[:50]:
        assert seen[start] == signal[start - 1]
    lengths = np.flatnonzero(held[:-1] & ~held[1:])[: starts.size] - starts + 1
    assert np.median(lengths) == pytest.approx(2e-3 * RATE, abs=1)
