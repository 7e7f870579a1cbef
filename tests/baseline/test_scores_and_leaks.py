"""Scores against scikit-learn and scipy; folds that never part a group; models on data whose answer is known."""

import numpy as np
import pytest
from scipy.stats import spearmanr
from sklearn.metrics import balanced_accuracy_score, f1_score

from rubgen.baseline.baseline import mark_of
from rubgen.baseline.evaluate import FOLDS, Samples, cross_validated, folds, transferred
from rubgen.baseline.models import OneFeature, models
from rubgen.baseline.scores import balanced_accuracy, best_threshold, macro_f1, rank_correlation

RNG = np.random.default_rng(4)
TRUTH, CALLED = RNG.integers(0, 3, 200), RNG.integers(0, 3, 200)


def test_scores_are_those_of_other_packages():
    assert balanced_accuracy(CALLED, TRUTH) == pytest.approx(balanced_accuracy_score(TRUTH, CALLED))
    assert macro_f1(CALLED, TRUTH) == pytest.approx(f1_score(TRUTH, CALLED, average="macro"))
    assert rank_correlation(CALLED, TRUTH) == pytest.approx(spearmanr(CALLED, TRUTH).statistic)
    assert rank_correlation(np.ones(5), np.arange(5)) == 0


def test_a_threshold_lies_between_the_classes():
    found = best_threshold(np.array([4.0, 1.0, 2.0, 7.0]), np.array([True, False, False, True]))
    assert found == (1.0, 3.0, True)
    assert best_threshold(-np.array([4.0, 1.0, 2.0, 7.0]), np.array([True, False, False, True])) == (1.0, -3.0, False)


def test_a_group_is_tested_once_and_never_on_both_sides():
    groups, answers = RNG.integers(0, 23, 300), RNG.integers(0, 2, 300)
    tested = np.array(list(folds(groups, answers, seed=1)))
    assert (tested.sum(axis=0) == 1).all()
    assert all(set(groups[test]).isdisjoint(groups[~test]) for test in tested)
    assert (tested.sum(axis=1) > 0).all()


def test_each_class_is_spread_over_the_folds():
    groups, answers = np.arange(40), np.repeat([0, 1], [35, 5])
    assert [int(answers[test].sum()) for test in folds(groups, answers, seed=0)] == [1] * FOLDS


def _identity_only(groups=40, windows=8):
    """Windows whose features name their group and say nothing of its answer, which is a coin's."""
    rng = np.random.default_rng(0)
    owner = np.repeat(np.arange(groups), windows)
    places = rng.standard_normal((groups, 3))
    features = places[owner] + 0.01 * rng.standard_normal((owner.size, 3))
    return Samples(features, (np.arange(groups) % 2)[owner], owner)


def test_a_leak_shows_where_features_name_the_group():
    samples, make = _identity_only(), models(numbers=False, classes=2)["boosting"]
    by_group, _ = cross_validated(samples, make, balanced_accuracy, by_group=True)
    leaky, _ = cross_validated(samples, make, balanced_accuracy, by_group=False)
    assert leaky > 0.95
    assert by_group < 0.7


def test_a_task_of_one_threshold_is_marked():
    rng = np.random.default_rng(1)
    answers, noise = np.arange(200) % 2, rng.standard_normal((200, 4))
    noise[:, 2] = answers + 0.1 * noise[:, 2]
    samples = Samples(noise, answers, np.arange(200) // 2)
    scores = {
        name: {"by group": cross_validated(samples, make, balanced_accuracy, by_group=True)}
        for name, make in models(numbers=False, classes=2).items()
    }
    assert scores["majority"]["by group"] == (0.5, 0)
    assert scores["one threshold"]["by group"][0] > 0.98
    assert mark_of(scores).startswith("one threshold solves it")
    assert transferred(samples, samples, models(numbers=False, classes=2)["boosting"], balanced_accuracy)[0] > 0.98


def test_a_task_of_noise_is_marked_and_a_good_one_is_not():
    assert mark_of({"one threshold": {"by group": (0.52, 0)}, "boosting": {"by group": (0.58, 0)}}) == (
        "nothing learns it (0.58 < 0.6)"
    )
    assert mark_of({"one threshold": {"by group": (0.7, 0)}, "boosting": {"by group": (0.85, 0)}}) == ""


def test_one_feature_ranks_numbers_in_either_sense_and_takes_undefined_values():
    rng = np.random.default_rng(2)
    answers, features = rng.uniform(size=100), rng.uniform(size=(100, 3))
    features[:, 1] = -answers
    features[:5, 0] = np.nan
    assert rank_correlation(OneFeature().fit(features, answers).predict(features), answers) == pytest.approx(1)
