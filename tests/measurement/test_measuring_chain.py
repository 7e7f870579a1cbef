import numpy as np
import pytest
from scipy.signal import firwin, freqz

from rubgen.measurement import margin_seconds
from rubgen.measurement.chain import (
    PASS_BAND_SHARE,
    band_limit,
    digitise,
    filter_bank,
    half_width_seconds,
    impulse_response,
)
from rubgen.measurement.resampling_kernels import ABREAST, interpolate_rows
from rubgen.scenario import Sensing

RATE = 25600.0
NYQUIST = RATE / 2
STEP_RATES = [170666.7, 113777.3, 2.56 * RATE * 1.001]


def tone_response(frequency: float, step_rate: float, rate: float = RATE) -> np.ndarray:
    """Complex gain at each of 200 samples for the tone exp(2 pi i f t); an ideal filter gives a constant 1 or 0."""
    margin = int(np.ceil(half_width_seconds(rate) * step_rate)) + 1
    positions = margin + 0.37 + np.arange(200) * step_rate / rate
    steps = np.arange(int(positions[-1]) + margin + 2)
    phase = 2 * np.pi * frequency / step_rate
    parts = [np.cos(phase * steps), np.sin(phase * steps)]
    out = band_limit(parts, positions, dt=1 / step_rate, sample_rate_hz=rate)
    return (out[:, 0] + 1j * out[:, 1]) * np.exp(-1j * phase * positions)


@pytest.mark.parametrize("step_rate", STEP_RATES)
def test_tones_in_the_pass_band_keep_amplitude_and_phase(step_rate: float) -> None:
    # One complex number holds gain and delay: it must be 1 at every sample, whatever its place between two steps.
    for share in [0.0, 0.013, 0.2, 0.5, 0.7, 0.9, 1.0]:
        gain = tone_response(share * PASS_BAND_SHARE * NYQUIST, step_rate)
        assert np.abs(gain - 1).max() < 1e-4


@pytest.mark.parametrize("step_rate", STEP_RATES)
def test_at_least_85_db_at_nyquist_and_everywhere_beyond(step_rate: float) -> None:
    frequencies = np.concatenate([[NYQUIST], np.linspace(NYQUIST, step_rate / 2, 60)])
    worst = max(np.abs(tone_response(f, step_rate)).max() for f in frequencies)
    assert 20 * np.log10(worst) < -85


@pytest.mark.parametrize(("step_rate", "decibel"), [(STEP_RATES[0], -117), (STEP_RATES[2], -109)])
def test_weights_between_two_tabulated_places_err_little(step_rate: float, decibel: float) -> None:
    bank = filter_bank(1 / step_rate, RATE)
    half = bank.shape[1] // 2
    phase = (np.arange(bank.shape[0] - 1) + 0.5) / (bank.shape[0] - 1)
    steps = np.arange(-half + 1, half + 1)
    exact = impulse_response((phase[:, None] - steps) / step_rate, RATE)
    error = (bank[1:] + bank[:-1]) / 2 - exact / exact.sum(axis=1, keepdims=True)
    tones = np.exp(2j * np.pi * np.outer(steps, np.linspace(0, 0.5, 200)))
    assert 20 * np.log10(np.abs(error @ tones).max()) < decibel


def test_half_the_amplitude_midway_in_the_transition_band() -> None:
    gain = tone_response((1 + PASS_BAND_SHARE) / 2 * NYQUIST, 170666.7)
    assert np.abs(gain) == pytest.approx(0.5, abs=1e-3)


def test_filter_is_scipys_kaiser_design() -> None:
    step_rate = 8 * RATE
    half = int(half_width_seconds(RATE) * step_rate)
    taps = impulse_response(np.arange(-half, half + 1) / step_rate, RATE) / step_rate
    beta = 0.1102 * (90 - 8.7)
    # scipy's window ends at the last tap, ours at the stated half width just beyond it.
    design = firwin(2 * half + 1, (1 + PASS_BAND_SHARE) / 2 * NYQUIST, window=("kaiser", beta), fs=step_rate)
    ours, theirs = (np.abs(freqz(b, worN=512)[1]) for b in (taps, design))
    assert np.abs(ours - theirs).max() < 2e-5


def test_integral_of_impulses_is_preserved() -> None:
    rng = np.random.default_rng(1)
    step_rate, dt = 170666.7, 1 / 170666.7
    force = np.zeros(60_000)
    hits = rng.integers(10_000, 50_000, 40)
    force[hits] += rng.uniform(0.01, 0.3, hits.size) / dt  # single-step multipliers: impulse / dt
    positions = np.arange(1000.0, 59_000.0, step_rate / RATE)
    recorded = band_limit([force], positions, dt=dt, sample_rate_hz=RATE)
    assert recorded.sum() / RATE == pytest.approx(force.sum() * dt, rel=1e-5)


def test_peak_of_an_impulse_does_not_depend_on_the_step() -> None:
    peaks = []
    for step_rate in [100_000.0, 200_000.0, 400_000.0]:
        force = np.zeros(int(0.02 * step_rate))
        middle = force.shape[0] // 2
        force[middle] = step_rate  # 1 N s
        positions = middle + (np.arange(-50, 51) + 0.3) * step_rate / RATE
        peaks.append(band_limit([force], positions, dt=1 / step_rate, sample_rate_hz=RATE).max())
    assert peaks == pytest.approx([peaks[0]] * 3, rel=1e-3)


def test_constant_passes_exactly() -> None:
    signal = np.full(3000, 8.3e-3)
    out = band_limit([signal], np.linspace(500, 2400, 301), dt=1 / 170666.7, sample_rate_hz=RATE)
    assert out == pytest.approx(8.3e-3, rel=1e-13)


@pytest.mark.parametrize("channels", [1, 5, 16, 17, 35])
def test_every_channel_is_filtered_by_itself(channels: int) -> None:
    """Against the sum of h((position - step) dt) x over all steps, each channel another signal."""
    dt = 1 / 70_000
    half = filter_bank(dt, RATE).shape[1] // 2
    signals = np.random.default_rng(channels).standard_normal((2 * half + 30, channels))
    positions = half + np.array([0.0, 3.25, 17.5, 28.75])  # rows of the bank: nothing is interpolated
    weights = impulse_response((positions[:, None] - np.arange(len(signals))) * dt, RATE)
    expected = weights / weights.sum(axis=1, keepdims=True) @ signals
    found = band_limit([*signals.T], positions, dt=dt, sample_rate_hz=RATE)
    assert found.shape == (4, channels)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)
    alone = band_limit([signals[:, -1]], positions, dt=dt, sample_rate_hz=RATE)
    np.testing.assert_array_equal(alone, found[:, -1:])  # to the bit, whatever stands beside it


def test_samples_are_filtered_as_if_all_were_filtered_at_once() -> None:
    dt, rng = 1 / 70_000, np.random.default_rng(3)
    bank = filter_bank(dt, RATE)
    positions = bank.shape[1] + 0.3 + np.arange(1200) * 1.7  # some blocks of samples and a part of one
    signals = rng.standard_normal((int(positions[-1]) + bank.shape[1], ABREAST))
    at_once = np.zeros((positions.size, ABREAST))
    interpolate_rows(signals, bank, positions, at_once)
    found = band_limit([*signals.T], positions, dt=dt, sample_rate_hz=RATE)
    np.testing.assert_array_equal(found, at_once)


def test_compiled_and_plain_kernel_agree() -> None:
    rng = np.random.default_rng(0)
    bank = filter_bank(1 / 70_000, RATE)
    signals = rng.standard_normal((bank.shape[1] + 40, ABREAST))
    positions = bank.shape[1] // 2 + rng.uniform(0, 38, 5)
    positions[0] = np.floor(positions[0])  # exactly on a step
    compiled, plain = np.zeros((2, 5, ABREAST))
    interpolate_rows(signals, bank, positions, compiled)
    getattr(interpolate_rows, "py_func", interpolate_rows)(signals, bank, positions, plain)
    assert compiled == pytest.approx(plain, rel=1e-12, abs=1e-14)


def test_margin_covers_both_sides_of_the_filter() -> None:
    sensing = Sensing(sample_rate_hz=12800.0)
    assert margin_seconds(sensing) >= 2 * half_width_seconds(12800.0)
    assert impulse_response(np.array([half_width_seconds(12800.0)]), 12800.0)[0] == 0


def test_adc_rounds_to_its_grid_and_clips_to_its_range() -> None:
    signal = np.array([0.0, 0.49, 0.51, -3.0, 200.0, -200.0, 127.4])
    out = digitise(signal, range_min=-128.0, range_max=128.0, bits=8)
    assert out.tolist() == [0.0, 0.0, 1.0, -3.0, 127.0, -128.0, 127.0]


def test_quantisation_error_is_uniform_over_one_step() -> None:
    signal = np.random.default_rng(2).uniform(-0.9, 0.9, 20_000)
    step = 2 / 2**10
    error = digitise(signal, range_min=-1.0, range_max=1.0, bits=10) - signal
    assert np.abs(error).max() <= step / 2 * (1 + 1e-9)
    assert error.std() == pytest.approx(step / np.sqrt(12), rel=0.03)
