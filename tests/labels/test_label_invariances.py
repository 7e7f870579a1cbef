"""What must not change labels, and the smallest records: one touch, fewer turns than a window, all points equal."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from rubgen.labels.contact.zones import BINS, contact_zones, impulse_histogram, touched_arcs, turn_imbalance
from rubgen.labels.harmonics import harmonics, spectrum_turns
from rubgen.labels.labels import Motion
from rubgen.labels.motion.clusters import (
    cluster_distances,
    cluster_period,
    late_distances,
    off_cluster,
    stray,
    without_periodic_part,
)
from rubgen.labels.motion.decision import MotionClass, combined
from rubgen.labels.motion.intermittency import segments
from rubgen.labels.motion.whirl import WhirlDirection, whirl
from rubgen.labels.windows import window_edges, windows
from rubgen.solver.response import WINDOW_TURNS

STEPS = 256
RNG = np.random.default_rng(6)


@pytest.fixture
def scattered(events):
    """Touches of two unlike zones, of many lengths, some of them across angle 0."""
    angle = np.where(np.arange(400) % 2, 0.02, 2.4) + 0.1 * RNG.normal(size=400)
    return events(angle, RNG.gamma(2.0, 0.1, 400), RNG.integers(1, 12, 400), start=STEPS // 2 * np.arange(400))


@pytest.mark.parametrize("bins", [1, 117, BINS - 1])
def test_a_turned_casing_has_its_zones_turned_and_as_wide(scattered, bins):
    by = 2 * np.pi * bins / BINS
    turned = replace(scattered, angle=np.mod(scattered.angle + by, 2 * np.pi))
    first, second = impulse_histogram(scattered, STEPS), impulse_histogram(turned, STEPS)
    np.testing.assert_allclose(second, np.roll(first, bins), atol=1e-9 * first.max())
    before, after = contact_zones(scattered, steps_per_turn=STEPS), contact_zones(turned, steps_per_turn=STEPS)
    assert len(before.centres) == 2
    order = np.argsort(np.mod(np.array(before.centres) + by, 2 * np.pi))
    np.testing.assert_allclose(after.centres, np.mod(np.array(before.centres) + by, 2 * np.pi)[order], atol=1e-6)
    np.testing.assert_allclose(after.widths, np.array(before.widths)[order], atol=1e-9)
    np.testing.assert_allclose(after.shares, np.array(before.shares)[order], rtol=1e-6)
    assert after.imbalance == pytest.approx(before.imbalance, rel=1e-6)


def test_a_casing_in_a_mirror_has_its_zones_mirrored(scattered):
    mirrored = replace(scattered, angle=np.mod(-scattered.angle, 2 * np.pi))
    before, after = contact_zones(scattered, steps_per_turn=STEPS), contact_zones(mirrored, steps_per_turn=STEPS)
    np.testing.assert_allclose(np.sort(np.mod(-np.array(after.centres), 2 * np.pi)), before.centres, atol=1e-6)
    assert sorted(after.shares) == pytest.approx(sorted(before.shares), rel=1e-6)


def test_harder_touches_have_the_same_zones(scattered):
    harder = replace(scattered, impulse=1e3 * scattered.impulse)
    before, after = (contact_zones(each, steps_per_turn=STEPS) for each in (scattered, harder))
    assert after.widths == pytest.approx(before.widths, abs=1e-9)
    assert after.imbalance == pytest.approx(before.imbalance, rel=1e-9)


def test_a_single_touch_is_one_zone_as_wide_as_it_swept(events):
    one = events(np.array([1.0]), np.array([0.3]), np.array([16]))
    zones = contact_zones(one, steps_per_turn=STEPS)
    assert zones.centres == pytest.approx([1.0], abs=1e-3)
    assert zones.widths[0] == pytest.approx(2 * np.pi * 16 / STEPS, abs=2 * 2 * np.pi / BINS)
    assert 0.98 <= zones.shares[0] <= 1  # the lightest bins, at its ends, do not count
    assert (zones.symmetric, zones.imbalance) == (False, 0.0)


def test_unequal_zones_are_unbalanced_by_their_difference_over_their_sum(events):
    """Standard deviation over mean of a and b in every turn."""
    turns, a, b = 20, 0.5, 0.2
    angle = np.tile([0.5, 0.5 + np.pi], turns)
    start = STEPS * np.repeat(np.arange(turns), 2) + np.tile([20, 20 + STEPS // 2], turns)
    touches = events(angle, np.tile([a, b], turns), np.full(2 * turns, 4), start=start)
    centres = np.array([0.5, 0.5 + np.pi])
    assert turn_imbalance(touches, centres, STEPS) == pytest.approx((a - b) / (a + b), rel=1e-9)


def test_arcs_on_a_circle_begin_where_the_gap_before_them_ends():
    touched = np.zeros(BINS, dtype=bool)
    touched[[*range(700, 720), *range(5), 100, 300, 310]] = True
    assert sorted(touched_arcs(touched)) == [(100, 1), (300, 11), (700, 25)]
    assert sorted(touched_arcs(np.roll(touched, 50))) == [(30, 25), (150, 1), (350, 11)]
    alone = np.zeros(BINS, dtype=bool)
    alone[719] = True
    assert touched_arcs(alone) == [(719, 1)]
    wide = np.zeros(BINS, dtype=bool)
    wide[::20] = True  # gaps of 19 bins are closed, of 21 are not
    assert touched_arcs(wide) == [(0, BINS)]
    wide[20] = False
    assert touched_arcs(wide) == [(40, BINS - 39)]


def test_a_later_start_of_the_turn_turns_each_phase_by_its_order(respond):
    turns, steps = 20, 64
    theta = 2 * np.pi / steps * np.arange(turns * steps)
    signal = sum(np.cos(k * theta + 0.3 * k) / k for k in (1, 2, 5, 7))
    response = respond(turns=turns, tail_turns=turns, steps=steps)
    taps = {"first": signal, "later": np.roll(signal, -3), "scaled": 1e3 * signal}
    first, later, scaled = harmonics(replace(response, taps=taps)).values()
    for k in (1, 2, 5, 7):
        assert first.amplitudes[k - 1] == pytest.approx(1 / k, rel=1e-9)
        assert later.amplitudes[k - 1] == pytest.approx(1 / k, rel=1e-9)
        turned = later.phases[k - 1] - first.phases[k - 1] - k * 3 * 2 * np.pi / steps
        assert abs(np.exp(1j * turned) - 1) < 1e-9
    assert first.even_share + first.odd_share == pytest.approx(1.0)
    assert scaled.even_share == pytest.approx(first.even_share, rel=1e-12)
    assert scaled.dominant == first.dominant == 1


def test_even_and_odd_field_of_the_casing_add_up_to_its_acceleration(respond):
    turns, steps = 12, 64
    first, opposite = RNG.normal(size=(2, turns * steps))
    taps = {"casing_acc_0": first, "casing_acc_180": opposite}
    response = respond(turns=turns, tail_turns=turns, steps=steps, taps=taps)
    found = harmonics(response)
    assert spectrum_turns(response) == turns
    lines = {name: each.amplitudes * np.exp(1j * each.phases) for name, each in found.items()}
    np.testing.assert_allclose(lines["casing_even"] + lines["casing_odd"], lines["casing_acc_0"], atol=1e-12)
    np.testing.assert_allclose(lines["casing_even"] - lines["casing_odd"], lines["casing_acc_180"], atol=1e-12)


@pytest.mark.parametrize("turns", [1, WINDOW_TURNS - 1, WINDOW_TURNS, WINDOW_TURNS + 1])
def test_a_record_shorter_than_a_window_is_one_window(respond, turns):
    """Impulse and duty are means over the turns that there are."""
    response = respond(turns=turns, tail_turns=turns)
    response = replace(response, window_orders=np.zeros((1, 1, 20), dtype=complex))
    count = -(-turns // WINDOW_TURNS)
    assert window_edges(response).tolist() == [*range(0, turns, WINDOW_TURNS), turns]
    found = windows(response)
    assert found.start == pytest.approx(WINDOW_TURNS * response.turn_seconds * np.arange(count))
    assert found.speed == pytest.approx(np.full(count, response.speed))
    assert found.impulse == pytest.approx(np.full(count, 1.5))
    assert found.duty == pytest.approx(np.full(count, 0.25))


@pytest.mark.parametrize("turns", [16, 33, 64])
@pytest.mark.parametrize("period", [1, 2, 3, 7])
def test_what_is_off_a_cluster_is_the_distance_to_its_mean(turns, period):
    """Against a loop, for a number of turns that the period does not divide; and the farthest group counts."""
    points = RNG.normal(size=(turns, 3, 4))
    expected = np.empty_like(points)
    for start in range(period):
        expected[start::period] = points[start::period] - points[start::period].mean(axis=0)
    np.testing.assert_allclose(off_cluster(points, period), expected, atol=1e-13)
    farthest = np.linalg.norm(expected, axis=2).max(axis=1)
    np.testing.assert_allclose(cluster_distances(points, period), farthest, rtol=1e-12)


@pytest.mark.parametrize("period", range(1, 17))
def test_each_period_up_to_sixteen_is_found_from_any_turn_and_at_any_place(period):
    points = np.tile(RNG.normal(size=(period, 2, 4)), (260 // period + 1, 1, 1))[:256]
    for each in (points, np.roll(points, 5, axis=0)[5:], points + 7.0, points[:, ::-1]):
        distances = late_distances(each)
        assert cluster_period(distances) == period
        assert stray(distances, period) == pytest.approx(0, abs=1e-12)
        assert not without_periodic_part(each).round(9).any()


def test_a_period_beyond_sixteen_is_none():
    points = np.tile(RNG.normal(size=(17, 1, 4)), (40, 1, 1))
    assert cluster_period(late_distances(points)) is None


def test_stretches_cover_every_turn_once():
    points = RNG.normal(size=(200, 1, 4))
    points[30:90] = points[30]
    points[120:180:2], points[121:180:2] = points[120], points[121]
    found = segments([points])
    assert [found[0].start, found[-1].end] == [0, 200]
    assert all(before.end == after.start for before, after in pairwise(found))
    assert [(each.start, each.end, each.period) for each in found if each.period] == [(30, 90, 1), (120, 180, 2)]


def test_the_whirl_is_that_of_its_mirror_the_other_way_round_and_of_any_size():
    angle = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    place = 3e-4 * np.exp(1j * angle) + 1e-4 * np.exp(-1j * angle) + 5e-5
    speed = 700.0 * 1j * (3e-4 * np.exp(1j * angle) - 1e-4 * np.exp(-1j * angle))

    def of(place, speed):
        areal = place.real * speed.imag - place.imag * speed.real
        means = [place.real, place.imag, np.abs(place) ** 2, np.abs(speed) ** 2, areal]
        return whirl(np.array([[each.mean() for each in means]]))

    found = of(place, speed)
    assert (found.direction, found.index) == (WhirlDirection.FORWARD, pytest.approx((9 - 1) / (9 + 1)))
    for turned in (np.exp(1.3j), 1e3, 1e-4):
        assert of(turned * place, turned * speed).index == pytest.approx(found.index, rel=1e-9)
    back = of(place.conj(), speed.conj())
    assert (back.direction, back.index) == (WhirlDirection.BACKWARD, pytest.approx(-found.index))
    assert whirl(np.zeros((0, 5))) is None


def test_the_class_of_the_whole_does_not_depend_on_the_order_of_its_parts():
    parts = [
        MotionClass(motion=motion, period={Motion.PERIOD_1: 1, Motion.PERIOD_K: 3}.get(motion), confidence=0.5)
        for motion in Motion
    ]
    for first in parts:
        assert combined(first, first).motion is first.motion
        for second in parts:
            whole = combined(first, second)
            assert whole == combined(second, first)
            assert list(Motion).index(whole.motion) == max(list(Motion).index(p.motion) for p in (first, second))
