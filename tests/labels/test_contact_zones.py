from collections.abc import Callable

import numpy as np
import pytest

from rubgen.labels.contact.zones import contact_zones, impulse_histogram
from rubgen.solver.response import ContactEvents

Events = Callable[..., ContactEvents]
STEPS = 1024
STEP = 2 * np.pi / STEPS


def around(*centres: float, half: float = 15.0, count: int = 200) -> np.ndarray:
    """Angles in rad spread evenly over +- half about each centre, in degrees."""
    return np.deg2rad(np.concatenate([centre + np.linspace(-half, half, count) for centre in centres]))


def alternating() -> np.ndarray:
    """400 touches, by turns at 0 and pi, a little spread but alike in every pair."""
    return np.repeat(np.deg2rad(np.linspace(-5, 5, 200)), 2) + np.tile([0.0, np.pi], 200)


def half_turns() -> np.ndarray:
    """Steps at which 400 touches start, two a turn, the first of a turn at theta = 0."""
    return 1024 + 512 * np.arange(400)


def test_two_equal_zones_opposite_each_other_are_symmetric(events: Events) -> None:
    pairs = around(0.0, 180.0).reshape(2, -1).T.ravel()
    zones = contact_zones(events(pairs, start=half_turns()), steps_per_turn=STEPS)
    assert len(zones.centres) == 2
    # The zone about 0 may come first, as 0.1 deg, or last, as 359.9 deg.
    assert sorted(np.cos(zones.centres)) == pytest.approx([-1.0, 1.0], abs=1e-4)
    # 30 deg and ten steps of sweep: a trapezium 33.5 deg wide, less 1.45 deg of skirt at each end that hold 2 % of it.
    assert zones.widths == pytest.approx(np.deg2rad([30.6, 30.6]), abs=np.deg2rad(1.0))
    assert zones.shares == pytest.approx([0.5, 0.5], abs=0.02)
    assert zones.symmetric is True


def test_zones_are_ordered_by_centre_and_wrap_at_2_pi(events: Events) -> None:
    zones = contact_zones(events(around(359.0, 120.0)), steps_per_turn=STEPS)
    assert np.rad2deg(zones.centres) == pytest.approx([120.0, 359.0], abs=0.6)
    assert np.rad2deg(zones.widths) == pytest.approx([30.6, 30.6], abs=1.0)
    assert zones.symmetric is False  # not opposite each other


@pytest.mark.parametrize("lobes", [3, 5])
def test_as_many_zones_as_lobes(events: Events, lobes: int) -> None:
    in_turns = around(*(17 + 360 / lobes * np.arange(lobes))).reshape(lobes, -1).T.ravel()
    start = np.floor(np.arange(in_turns.size) * STEPS / lobes)
    zones = contact_zones(events(in_turns, start=start), steps_per_turn=STEPS)
    assert np.rad2deg(zones.centres) == pytest.approx(17 + 360 / lobes * np.arange(lobes), abs=0.6)
    assert zones.symmetric is True


def test_unequal_width_is_not_symmetric(events: Events) -> None:
    wider = np.concatenate([around(0.0, half=20.0), around(180.0, half=15.0)])
    assert contact_zones(events(wider), steps_per_turn=STEPS).symmetric is False


@pytest.mark.parametrize(("strength", "symmetric"), [(1.0, True), (1.05, True), (1.2, False)])
def test_zones_of_unequal_impulse_are_not_symmetric(events: Events, strength: float, symmetric: bool) -> None:
    impulse = np.tile([0.1, 0.1 * strength], 200)
    zones = contact_zones(events(alternating(), impulse, start=half_turns()), steps_per_turn=STEPS)
    assert zones.imbalance == pytest.approx((strength - 1) / (strength + 1), abs=1e-12)
    assert zones.symmetric is symmetric


def test_zones_that_differ_from_turn_to_turn_are_not_symmetric_though_their_means_are_equal(events: Events) -> None:
    # 0.1 and 0.2 N s change places every turn: each 0.05 off the mean of 0.15.
    impulse = np.tile([0.1, 0.2, 0.2, 0.1], 100)
    zones = contact_zones(events(alternating(), impulse, start=half_turns()), steps_per_turn=STEPS)
    assert zones.shares[0] == pytest.approx(zones.shares[1])
    assert zones.imbalance == pytest.approx(1 / 3, rel=1e-2)  # the first and the last turn are cut
    assert zones.symmetric is False


def test_touches_about_the_start_of_a_turn_are_not_torn_apart(events: Events) -> None:
    # The zone at 0 is touched at theta = 0, a few steps before or after: cut there, turns would get none or two.
    jitter = np.where(np.arange(400) % 2 == 0, np.random.default_rng(0).integers(-40, 40, 400), 0)
    zones = contact_zones(events(alternating(), start=half_turns() + jitter), steps_per_turn=STEPS)
    assert zones.imbalance == pytest.approx(0.0, abs=1e-12)


def test_touched_all_round_is_one_zone_of_the_whole_circle(events: Events) -> None:
    zones = contact_zones(events(np.linspace(0, 2 * np.pi, 1000)), steps_per_turn=STEPS)
    assert zones.widths == pytest.approx([2 * np.pi])
    assert zones.symmetric is True


def test_one_touch_that_never_ends_is_the_whole_circle(events: Events) -> None:
    zones = contact_zones(events(np.array([1.0]), steps=np.array([500_000])), steps_per_turn=STEPS)
    assert zones.widths == pytest.approx([2 * np.pi])


def test_specks_do_not_make_zones(events: Events) -> None:
    angles = np.concatenate([around(0.0, 180.0), [np.pi / 2]])
    light, heavy = (np.append(np.full(400, 0.1), last) for last in (0.3, 4.0))
    assert len(contact_zones(events(angles, light), steps_per_turn=STEPS).centres) == 2
    assert len(contact_zones(events(angles, heavy), steps_per_turn=STEPS).centres) == 3


@pytest.mark.parametrize(("gap", "zones"), [(9.0, 1), (11.0, 2)])
def test_gaps_of_more_than_10_degrees_separate(events: Events, gap: float, zones: int) -> None:
    sweep = np.rad2deg(STEP)
    angles = np.concatenate([around(40.0, half=10.0), around(60.0 + gap + sweep, half=10.0)])
    one_step = np.ones(angles.size)
    assert len(contact_zones(events(angles, steps=one_step), steps_per_turn=STEPS).centres) == zones


def test_centre_is_the_mean_by_impulse(events: Events) -> None:
    angles = np.deg2rad(np.array([80.0, 85.0, 90.0]))
    found = contact_zones(events(angles, np.array([1.0, 2.0, 5.0])), steps_per_turn=STEPS)
    assert np.rad2deg(found.centres) == pytest.approx([(80 + 2 * 85 + 5 * 90) / 8], abs=0.3)


def test_without_contact_there_is_nothing(events: Events) -> None:
    zones = contact_zones(events(np.zeros(0)), steps_per_turn=STEPS)
    assert (zones.centres, zones.widths, zones.symmetric) == ((), (), None)


def test_histogram_holds_the_whole_impulse_where_the_blades_swept(events: Events) -> None:
    rng = np.random.default_rng(0)
    angle, impulse, steps = rng.uniform(0, 2 * np.pi, 50), rng.uniform(0, 1, 50), rng.integers(1, 900, 50)
    histogram = impulse_histogram(events(angle, impulse, steps), STEPS)
    fine = np.zeros(720)  # the same by brute force: every event cut into 50,000 equal parts
    for a, p, s in zip(angle, impulse, steps, strict=True):
        parts = a + s * STEP * ((np.arange(50_000) + 0.5) / 50_000 - 0.5)
        fine += np.histogram(np.mod(parts, 2 * np.pi), bins=720, range=(0, 2 * np.pi))[0] * p / 50_000
    assert histogram.sum() == pytest.approx(impulse.sum())
    assert histogram == pytest.approx(fine, abs=2e-3 * fine.max())
