"""What must not change features, and what must change them by a known factor: units, zero, sense, delay, frame."""

import numpy as np
import pytest

from rubgen.features import vocabulary
from rubgen.features.condition import _velocity_rms
from rubgen.features.envelope import envelope_features
from rubgen.features.orders import orbit_features, order_features
from rubgen.features.plan import shaft_pairs
from rubgen.features.time_domain import time_features
from rubgen.features.turns import LEAST_POINTS, by_turn, circles
from rubgen.sensors.load import load_sensor_set

RATE, SPEED_HZ = 12800.0, 97.3
TIME = np.arange(6400) / RATE
PULSES = np.arange(0.2, 60) / SPEED_HZ
THETA = 2 * np.pi * (SPEED_HZ * TIME - 0.2)
RNG = np.random.default_rng(7)
ROUGH = np.cos(THETA - 0.7) + 0.4 * np.cos(2 * THETA + 1) + 0.2 * RNG.gamma(1.0, 1.0, TIME.size)
"""A signal with orders, and with skewed noise."""


def columns(features, unit):
    """Numbers of the features that have the channel's unit, or another."""
    return [number for number, each in enumerate(features) if (each.unit == vocabulary.SAME) is unit]


def every(signal, pulses=PULSES):
    parts = [time_features(signal[None]), order_features(by_turn(signal[None], RATE, pulses))]
    return np.concatenate([*parts, envelope_features(signal[None], RATE, pulses)], axis=1)[0]


EVERY = vocabulary.of_channel(("time", "order", "envelope"), RATE)


def test_features_in_the_unit_of_the_channel_scale_with_it_and_others_do_not():
    plain, scaled = every(ROUGH), every(1e3 * ROUGH)
    assert len(plain) == len(EVERY) == len({each.name for each in EVERY})
    same, own = columns(EVERY, True), columns(EVERY, False)
    np.testing.assert_allclose(scaled[same], 1e3 * plain[same], rtol=1e-9)
    np.testing.assert_allclose(scaled[own], plain[own], rtol=1e-9)


def test_the_zero_of_a_channel_moves_its_mean_alone():
    plain, moved = every(ROUGH), every(ROUGH + 50.0)
    assert EVERY[0].name == "mean"
    assert moved[0] - plain[0] == pytest.approx(50.0)
    np.testing.assert_allclose(moved[1:], plain[1:], rtol=1e-6, atol=1e-9)


def test_a_channel_of_the_other_sense_is_skewed_to_the_other_side_and_half_a_turn_late():
    plain, turned = (dict(zip([each.name for each in EVERY], every(x), strict=True)) for x in (ROUGH, -ROUGH))
    assert abs(plain["skewness"]) > 0.1
    for name, value in plain.items():
        expected = {"mean": -value, "skewness": -value, "order_1_phase": (value + 180) % 360}.get(name, value)
        assert turned[name] == pytest.approx(expected, rel=1e-9), name


def test_a_later_pulse_changes_the_phase_alone():
    """A quarter of a turn later: the maximum then comes after a smaller angle."""
    signal = 2 * np.cos(THETA - np.deg2rad(200)) + 0.5 * np.cos(3 * THETA)
    early, late = (
        dict(zip([e.name for e in vocabulary.ORDER], order_features(by_turn(signal[None], RATE, p))[0], strict=True))
        for p in (PULSES, PULSES + 0.25 / SPEED_HZ)
    )
    assert early["order_1_phase"] == pytest.approx(200, abs=0.05)
    assert late["order_1_phase"] == pytest.approx(110, abs=0.05)
    for name in ("order_1", "order_3", "synchronous_rms", "not_1x_rms"):
        assert late[name] == pytest.approx(early[name], rel=1e-3)


def test_the_mean_squares_of_what_repeats_and_what_does_not_add_up():
    turned = by_turn(ROUGH[None], RATE, PULSES)
    found = dict(zip([each.name for each in vocabulary.ORDER], order_features(turned)[0], strict=True))
    total = turned.var()
    assert found["synchronous_rms"] ** 2 + found["not_synchronous_rms"] ** 2 == pytest.approx(total, rel=1e-9)
    assert found["not_1x_rms"] ** 2 + found["order_1"] ** 2 / 2 == pytest.approx(total, rel=1e-9)


def test_signals_in_turns_are_exact_up_to_the_fifth_power_of_time():
    """Lagrange's polynomial through six samples, also near the ends of the signal."""
    pulses = np.array([0.3, 41.7, 90.2, 127.6]) / RATE
    samples = np.arange(129)
    for power in range(6):
        signal = (samples / 64 - 1.0) ** power
        turned = by_turn(signal[None], RATE, pulses)
        points = turned.shape[2]
        assert points == LEAST_POINTS
        at = np.interp(np.arange(3 * points) / points, np.arange(4), pulses * RATE)
        np.testing.assert_allclose(turned.ravel(), (at / 64 - 1.0) ** power, atol=1e-12)


def test_a_turn_has_as_many_points_as_the_longest_has_samples():
    pulses = np.array([0.0, 100.0, 350.5, 500.0]) / RATE
    assert by_turn(np.zeros((2, 600)), RATE, pulses).shape == (2, 3, 251)
    assert by_turn(np.zeros((2, 600)), RATE, pulses[:1]).shape == (2, 0, LEAST_POINTS)


def test_within_one_turn_nothing_can_be_told_to_repeat():
    found = order_features(by_turn(ROUGH[None], RATE, PULSES[:2]))[0]
    named = dict(zip([each.name for each in vocabulary.ORDER], found, strict=True))
    assert named["turns"] == 1
    assert np.isfinite([named["order_1"], named["synchronous_rms"], named["not_1x_rms"]]).all()
    assert np.isnan([named["not_synchronous_rms"], named["order_1_2"], named["order_2_3"]]).all()


@pytest.mark.parametrize(("second", "count"), [(0.5, 2), (0.12, 1), (0.0, 1)])
def test_an_impact_has_at_least_a_quarter_of_the_hardest(second, count):
    """Two impacts a turn, the second one softer. Ringing between them is far below."""
    signal = np.zeros(TIME.size)
    for size, place in ((1.0, 0.1), (second, 0.6)):
        for moment in (np.arange(48) + place) / SPEED_HZ:
            after = np.maximum(TIME - moment, 0)
            signal += size * np.sin(2 * np.pi * 3500 * after) * np.exp(-4000 * after)
    names = [each.name for each in vocabulary.envelope(RATE)]
    found = envelope_features(signal[None], RATE, PULSES)[0][names.index("envelope_2000_5000_hz_impacts_per_turn")]
    assert found == pytest.approx(count, rel=0.03)


def test_circles_are_a_fourier_series_over_whole_periods():
    """Against numpy's transform; a fifth turn of periods of two is left out; a real signal has conjugate circles."""
    turned = RNG.normal(size=(3, 5, 32))
    lines = np.fft.fft(turned[:, :4].reshape(3, 2, 64).mean(axis=1), axis=1) / 64
    for order in (1, 2, 5):
        (found,) = circles(turned, (order,), 2)
        np.testing.assert_allclose(found, lines[:, order], atol=1e-14)
        (backward,) = circles(turned, (-order,), 2)
        np.testing.assert_allclose(backward, found.conj(), atol=1e-14)
    assert np.isnan(circles(turned, (1, 2), 6)).all()


def orbit_of(place, angles):
    probes = [(place * np.exp(-1j * np.deg2rad(angle))).real for angle in angles]
    found = orbit_features(by_turn(np.array(probes), RATE, PULSES), angles)
    return dict(zip([each.name for each in vocabulary.ORBIT], found, strict=True))


PLACE = 3 * np.exp(1j * (THETA + 0.3)) + 1.2 * np.exp(-1j * (THETA - 1.1)) + 0.4 * np.exp(-2j * THETA)


def test_an_orbit_turned_in_space_has_its_angle_turned_and_all_else_the_same():
    plain, turned = (orbit_of(PLACE * np.exp(1j * np.deg2rad(by)), (45.0, 135.0)) for by in (0, 50))
    assert turned["orbit_angle"] == pytest.approx((plain["orbit_angle"] + 50) % 180, abs=1e-6)
    for name in set(plain) - {"orbit_angle"}:
        assert turned[name] == pytest.approx(plain[name], rel=1e-9, abs=1e-9), name


def test_an_orbit_in_a_mirror_whirls_the_other_way():
    plain, mirrored = orbit_of(PLACE, (0.0, 90.0)), orbit_of(PLACE.conj(), (0.0, 90.0))
    assert plain["orbit_minor"] == pytest.approx(1.8, rel=1e-3)
    assert mirrored["orbit_minor"] == pytest.approx(-plain["orbit_minor"], rel=1e-9)
    assert mirrored["orbit_major"] == pytest.approx(plain["orbit_major"], rel=1e-9)
    for side in vocabulary.SIDES:
        assert mirrored[f"forward_{side}"] == pytest.approx(plain[f"backward_{side}"], rel=1e-9, abs=1e-12)
    assert plain["backward_2"] == pytest.approx(0.4, rel=1e-3)


def test_probes_in_any_two_directions_see_one_orbit():
    first, second = orbit_of(PLACE, (0.0, 90.0)), orbit_of(PLACE, (20.0, -75.0))
    assert second == pytest.approx(first, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(("hertz", "share"), [(5.0, 0.0), (10.0, 1.0), (400.0, 1.0), (1000.0, 1.0), (1010.0, 0.0)])
def test_velocity_counts_lines_from_10_to_1000_hz(hertz, share):
    """Whole periods of a sine a cos(w t): a / (w sqrt(2)) within the band, its edges included."""
    time = np.arange(round(RATE)) / RATE
    found = _velocity_rms(9.81 + 3 * np.cos(2 * np.pi * hertz * time), RATE)
    assert found == pytest.approx(share * 3 / (2 * np.pi * hertz) / np.sqrt(2), rel=1e-9, abs=1e-12)


def test_a_pair_of_shaft_probes_has_one_unit_and_two_directions():
    sensors = load_sensor_set("field")
    names = [each.name for each in sensors.sampled]
    ((first, second, *angles),) = shaft_pairs(sensors, names)
    assert abs(np.sin(np.deg2rad(angles[1] - angles[0]))) > 0.2
    assert shaft_pairs(sensors, [name for name in names if name != first]) == ()
    assert shaft_pairs(sensors, [first, second]) == ((first, second, *angles),)
