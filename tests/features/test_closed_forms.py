"""Each feature against a signal whose value of it is known by a formula."""

import numpy as np
import pytest
from scipy import stats

from rubgen.features import vocabulary
from rubgen.features.envelope import envelope_features
from rubgen.features.orders import orbit_features, order_features
from rubgen.features.time_domain import time_features
from rubgen.features.turns import by_turn

RATE, SPEED_HZ = 25600.0, 141.7
TIME = np.arange(12800) / RATE
PULSES = np.arange(0.3, 80) / SPEED_HZ  # the first one is 0.3 turns after the first sample
THETA = 2 * np.pi * (SPEED_HZ * TIME - 0.3)


def named(features, values):
    assert len(features) == len(values)
    return {feature.name: value for feature, value in zip(features, values, strict=True)}


def of_orders(signal, pulses=PULSES):
    return named(vocabulary.ORDER, order_features(by_turn(signal[None], RATE, pulses))[0])


def of_orbit(x, y, angles=(0.0, 90.0)):
    return named(vocabulary.ORBIT, orbit_features(by_turn(np.array([x, y]), RATE, PULSES), angles))


def of_envelope(signal, pulses=PULSES):
    return named(vocabulary.envelope(RATE), envelope_features(signal[None], RATE, pulses)[0])


def test_a_sine_has_its_amplitude_at_its_order_and_nothing_elsewhere():
    found = of_orders(0.4 + 3 * np.cos(THETA - np.deg2rad(50)) + 0.5 * np.cos(7 * THETA))
    assert found["turns"] == 70
    assert found["order_1"] == pytest.approx(3, rel=1e-4)
    assert found["order_7"] == pytest.approx(0.5, rel=1e-3)
    assert found["order_1_phase"] == pytest.approx(50, abs=0.01)
    assert found["synchronous_rms"] == pytest.approx(np.hypot(3, 0.5) / np.sqrt(2), rel=1e-4)
    assert found["not_1x_rms"] == pytest.approx(0.5 / np.sqrt(2), rel=2e-3)
    assert max(found[f"order_{k}"] for k in vocabulary.ORDERS if k not in (1, 7)) < 1e-3
    assert found["not_synchronous_rms"] < 1e-3


@pytest.mark.parametrize(("name", "order"), [("1_3", 1 / 3), ("1_2", 1 / 2), ("2_3", 2 / 3)])
def test_a_fraction_of_the_speed_is_found_and_does_not_repeat_each_turn(name, order):
    found = of_orders(2 * np.cos(order * THETA + 1))
    assert found[f"order_{name}"] == pytest.approx(2, rel=1e-4)
    assert found["not_synchronous_rms"] == pytest.approx(np.sqrt(2), rel=0.02)
    assert found["order_1"] < 0.05


def test_orders_follow_a_changing_speed():
    turns = 100 * TIME + 60 * TIME**2  # from 100 to 160 turns a second
    pulses = np.interp(np.arange(65), turns, TIME)
    assert of_orders(np.cos(2 * np.pi * 5 * turns), pulses)["order_5"] == pytest.approx(1, rel=2e-3)


def test_without_turns_there_are_no_orders():
    found = of_orders(np.cos(THETA), pulses=PULSES[:1])
    assert found.pop("turns") == 0
    assert np.isnan([*found.values()]).all()


@pytest.mark.parametrize("sense", [1, -1])
def test_an_ellipse_has_its_half_axes_its_angle_and_its_sense(sense):
    along, across = 5 * np.cos(THETA), sense * 2 * np.sin(THETA)
    tilt = np.deg2rad(30)
    x, y = along * np.cos(tilt) - across * np.sin(tilt), along * np.sin(tilt) + across * np.cos(tilt)
    found = of_orbit(1 + x, y)
    assert found["orbit_major"] == pytest.approx(5, rel=1e-4)
    assert found["orbit_minor"] == pytest.approx(2 * sense, rel=1e-3)
    assert found["orbit_angle"] == pytest.approx(30, abs=0.01)
    assert found["s_max"] == pytest.approx(5, rel=1e-3)
    assert (found["forward_1"], found["backward_1"]) == pytest.approx((3.5, 1.5)[::sense], rel=1e-3)


def test_the_full_spectrum_parts_a_backward_whirl_at_half_the_speed():
    found = of_orbit(3 * np.cos(-THETA / 2), 3 * np.sin(-THETA / 2))
    assert found["backward_1_2"] == pytest.approx(3, rel=1e-4)
    assert found["forward_1_2"] < 1e-3


def test_probes_at_any_angles_see_the_same_orbit():
    x, y = 3 * np.cos(THETA), 1 * np.sin(THETA)
    a, b = np.deg2rad([45, 120])
    found = of_orbit(x * np.cos(a) + y * np.sin(a), x * np.cos(b) + y * np.sin(b), (45, 120))
    assert [found[name] for name in ("orbit_major", "orbit_minor")] == pytest.approx([3, 1], rel=1e-3)


def test_a_modulated_tone_has_its_modulation_as_envelope():
    found = of_envelope(2 * (1 + 0.5 * np.cos(2 * THETA)) * np.cos(2 * np.pi * 3500 * TIME))
    band = "envelope_2000_5000_hz"
    assert found[f"{band}_mean"] == pytest.approx(2, rel=0.01)
    assert found[f"{band}_order_2"] == pytest.approx(1, rel=0.02)
    assert found[f"{band}_order_1"] < 0.02
    assert found[f"{band}_rms"] == pytest.approx(1 / np.sqrt(2), rel=0.03)
    assert found[f"{band}_peak"] == pytest.approx(3, rel=0.03)
    assert found["envelope_5000_10000_hz_mean"] < 0.05


@pytest.mark.parametrize("impacts", [1, 2, 3, 5])
def test_impacts_are_counted(impacts):
    signal = 0.02 * np.random.default_rng(1).standard_normal(TIME.size)
    for moment in (np.arange(75 * impacts) / impacts + 0.41) / SPEED_HZ:
        after = np.maximum(TIME - moment, 0)
        signal += np.sin(2 * np.pi * 7000 * after) * np.exp(-4000 * after)
    found = of_envelope(signal)
    assert found["envelope_5000_10000_hz_impacts_per_turn"] == pytest.approx(impacts, rel=0.02)


def test_noise_has_no_impacts():
    noise = np.random.default_rng(2).standard_normal(TIME.size)
    assert of_envelope(noise)["envelope_5000_10000_hz_impacts_per_turn"] < 0.2


def test_bands_above_the_flat_part_of_the_channels_are_left_out():
    assert [band[1] for band in vocabulary.bands(6400.0)] == [2000]
    assert len(vocabulary.envelope(6400.0)) == envelope_features(np.ones((2, 640)), 6400.0, PULSES).shape[1]


def test_time_features_of_a_sine_and_of_noise():
    sine, noise = 4 + 3 * np.sin(2 * np.pi * np.arange(1000) / 1000), np.random.default_rng(0).gamma(2.0, 1.0, 1000)
    first, second = (named(vocabulary.TIME, row) for row in time_features(np.array([sine, noise])))
    assert [first[name] for name in ("mean", "rms", "peak", "peak_to_peak")] == pytest.approx([4, 3 / 2**0.5, 3, 6])
    assert first["crest_factor"] == pytest.approx(2**0.5)
    assert first["shape_factor"] == pytest.approx(np.pi / 8**0.5, rel=1e-4)
    assert first["impulse_factor"] == pytest.approx(np.pi / 2, rel=1e-4)
    assert first["kurtosis"] == pytest.approx(1.5)
    assert second["skewness"] == pytest.approx(stats.skew(noise))
    assert second["kurtosis"] == pytest.approx(stats.kurtosis(noise, fisher=False))


def test_ratios_of_a_constant_signal_are_undefined():
    found = named(vocabulary.TIME, time_features(np.full((1, 100), 7.1))[0])
    assert (found["mean"], found["peak_to_peak"]) == pytest.approx((7.1, 0))
    assert all(np.isnan(found[name]) for name in ("kurtosis", "crest_factor", "shape_factor", "impulse_factor"))
