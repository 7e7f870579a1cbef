from itertools import pairwise

import numpy as np
import pytest

from rubgen.baseline.scores import balanced_accuracy, best_threshold
from validation.difficulty.features import NAMES, ORDERS, angle_from, common, orders
from validation.difficulty.figure import background_groups
from validation.difficulty.scores import boosted, chance_level


def test_the_best_threshold_of_values_that_are_known():
    rub = np.array([False, False, True, True])
    assert best_threshold(np.array([1.0, 2.0, 3.0, 4.0]), rub).score == 1.0
    assert best_threshold(-np.array([1.0, 2.0, 3.0, 4.0]), rub).score == 1.0
    assert best_threshold(np.array([1.0, 3.0, 2.0, 4.0]), rub).score == pytest.approx(0.75)
    assert best_threshold(np.array([1.0, 1.0, 1.0, 1.0]), rub).score == 0.5
    assert best_threshold(np.array([1.0, 2.0, 2.0, 4.0]), rub).score == pytest.approx(0.75)


def test_a_feature_without_information_stays_at_the_level_of_chance():
    rng = np.random.default_rng(1)
    rub = rng.random(400) < 0.4
    level = chance_level(rub, tries=200)
    scores = [best_threshold(rng.standard_normal(400), rub).score for _ in range(200)]
    assert np.mean(np.array(scores) > level) == pytest.approx(0.05, abs=0.05)


def test_balanced_accuracy_weighs_both_classes_alike():
    rub = np.array([True] + [False] * 9)
    assert balanced_accuracy(np.zeros(10, dtype=bool), rub) == 0.5
    assert balanced_accuracy(rub, rub) == 1.0
    assert np.isnan(balanced_accuracy(rub[1:], rub[1:]))


def test_features_of_a_sine_are_those_of_its_formula():
    rate, frequency = 25600.0, 100.0
    time = np.arange(12800) / rate
    found = dict(zip(NAMES, common(5 + 2 * np.sin(2 * np.pi * frequency * time + 0.3), rate), strict=False))
    assert found["rms"] == pytest.approx(np.sqrt(2), rel=1e-6)
    assert found["crest_factor"] == pytest.approx(np.sqrt(2), rel=1e-4)
    assert found["impulse_factor"] == pytest.approx(np.pi / 2, rel=1e-3)
    assert found["shape_factor"] == pytest.approx(np.pi / 2 / np.sqrt(2), rel=1e-3)
    assert found["peak_to_peak"] == pytest.approx(4, rel=1e-4)
    assert found["kurtosis"] == pytest.approx(1.5, rel=1e-3)
    assert found["zero_crossings"] == pytest.approx(2 * frequency / rate, rel=0.02)
    assert found["strongest_frequency"] == pytest.approx(frequency)
    assert found["median_frequency"] == pytest.approx(frequency)
    assert found["below_1_khz"] == pytest.approx(2, rel=0.01)  # its mean square
    assert np.isfinite(common(np.zeros(1000), rate)).all()


def test_orders_come_from_the_pulses_at_a_speed_that_changes():
    rate = 25600.0
    time = np.arange(25600) / rate
    turns = 100 * time + 20 * time**2
    signal = 3 * np.cos(2 * 2 * np.pi * turns) + np.cos(7 * 2 * np.pi * turns)
    angle = angle_from(np.interp(np.arange(1, 120), turns, time), time)
    found = dict(zip(NAMES[-len(ORDERS) - 1 :], orders(signal, angle, blades=7), strict=True))
    assert found["order_2"] == pytest.approx(3, rel=0.01)
    assert found["order_blades"] == pytest.approx(1, rel=0.03)
    assert max(found[f"order_{order}"] for order in ORDERS if order != 2) < 0.05
    with pytest.raises(ValueError, match="1 pulses give no angle"):
        angle_from([0.1], time)


def test_boosting_learns_what_is_there_and_nothing_else():
    rng = np.random.default_rng(0)
    rub = rng.random(150) < 0.4
    told = np.column_stack([rub + 0.1 * rng.standard_normal(150), rng.standard_normal(150)])
    assert boosted(told, rub).accuracy()[0] > 0.95
    untold = boosted(rng.standard_normal((150, 2)), rub)
    assert abs(untold.accuracy()[0] - 0.5) < 0.12
    assert np.isnan(untold.called_rub(np.zeros(150, dtype=bool)))


def test_groups_of_the_background_have_equal_sizes_and_rise():
    levels = np.random.default_rng(0).random(50)
    groups = background_groups(levels)
    assert [group.sum() for group in groups] == [10] * 5
    assert all(levels[a].max() < levels[b].min() for a, b in pairwise(groups))
    assert [group.sum() for group in background_groups(np.zeros(50))] == [50]
