"""Scores against scikit-learn and scipy; folds that never part a group; models on data whose answer is known."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import spearmanr
from sklearn.metrics import balanced_accuracy_score, f1_score

from rubgen.baseline.baseline import mark_of
from rubgen.baseline.evaluate import FOLDS, Outcome, Samples, cross_validated, folds, transferred
from rubgen.baseline.models import Model, OneFeature, Ridge, models
from rubgen.baseline.rocket import KERNELS, fitted
from rubgen.baseline.scores import (
    balanced_accuracy,
    best_threshold,
    detection_rate,
    label_f1,
    macro_f1,
    rank_correlation,
)
from rubgen.baseline.tasks import SECTORS, TASKS, onset_error, sectors_of

RNG = np.random.default_rng(4)
METRIC, METRICS = "balanced accuracy", TASKS["rub"].metrics
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


def of_features(features, answers, owner):
    inputs = {"features": features} | {f"rocket {seed}": features for seed in range(3)}
    nothing = np.full(len(owner), np.nan)
    return Samples(inputs, answers, owner, owner, np.zeros((len(owner), 2)), nothing)


def _identity_only(groups=40, windows=8):
    """Windows whose features name their group and say nothing of its answer, which is a coin's."""
    rng = np.random.default_rng(0)
    owner = np.repeat(np.arange(groups), windows)
    places = rng.standard_normal((groups, 3))
    features = places[owner] + 0.01 * rng.standard_normal((owner.size, 3))
    return of_features(features, (np.arange(groups) % 2)[owner], owner)


def test_a_leak_shows_where_features_name_the_group():
    samples = _identity_only()
    made = models(samples.answers)["boosting"]
    by_group, _ = cross_validated(samples, made, METRICS, by_group=True)[METRIC]
    leaky, _ = cross_validated(samples, made, METRICS, by_group=False)[METRIC]
    assert leaky > 0.95
    assert by_group < 0.7


def test_a_task_of_one_threshold_is_marked():
    rng = np.random.default_rng(1)
    answers, noise = np.arange(200) % 2, rng.standard_normal((200, 4))
    noise[:, 2] = answers + 0.1 * noise[:, 2]
    samples = of_features(noise, answers, np.arange(200) // 2)
    scores = {
        name: {"by group": cross_validated(samples, made, METRICS, by_group=True)}
        for name, made in models(answers).items()
    }
    assert scores["majority"]["by group"] == {METRIC: (0.5, 0), "detected at 1 % false alarms": (0, 0)}
    assert all(scores[name]["by group"][METRIC][0] > 0.98 for name in ("one threshold", "boosting", "rocket"))
    assert scores["one threshold"]["by group"]["detected at 1 % false alarms"][0] > 0.98
    assert mark_of(scores, TASKS["rub"]).startswith("one threshold solves it")
    opposite = replace(samples, answers=1 - answers)
    found = transferred(samples, {"same": samples, "opposite": opposite}, models(answers)["boosting"], METRICS)
    assert found["same"][METRIC][0] > 0.98
    assert found["opposite"][METRIC][0] < 0.02


def said(way, metric="balanced accuracy", **scores):
    """Return scores by model, way and metric."""
    return {name.replace("_", " "): {way: {metric: (score, 0.0)}} for name, score in scores.items()}


def test_a_task_of_noise_is_marked_and_a_good_one_is_not():
    noise = said("by group", majority=0.5, one_threshold=0.52, boosting=0.58)
    assert mark_of(noise, TASKS["rub"]) == "nothing learns it (0.58 < 0.6)"
    good = said("by group", majority=0.5, one_threshold=0.7, boosting=0.85)
    assert mark_of(good, TASKS["rub"]) == ""
    lopsided = said("by group", majority=0.94, one_threshold=0.9, boosting=0.945)
    assert mark_of(lopsided, TASKS["rub"]) == "nothing learns it (0.94, the majority 0.94)"
    assert mark_of(said("by group", majority=0.94, one_threshold=0.9, boosting=0.95), TASKS["rub"]) == ""


def test_an_onset_is_learned_where_the_error_is_below_that_of_the_majority():
    metric = "median error, s"
    assert mark_of(said("on run_ups", metric, majority=0.3, one_threshold=0.4, boosting=0.1), TASKS["onset"]) == ""
    bad = said("on run_ups", metric, majority=0.3, one_threshold=0.4, boosting=0.28)
    assert mark_of(bad, TASKS["onset"]) == "nothing learns it (0.28 s, the majority 0.3 s)"


def test_detections_are_counted_above_all_but_one_percent_of_the_false():
    truth = np.repeat([0, 1], [200, 4])
    ranks = np.concatenate([np.arange(200) / 200, [0.994, 0.984, 0.5, 2.0]])
    assert detection_rate(ranks, truth) == 0.5  # two false ones may be above, 0.995 and 0.99
    assert detection_rate(np.zeros(204), truth) == 0
    assert np.isnan(detection_rate(ranks, np.ones(204)))


def test_labels_that_never_occur_do_not_count():
    truth, called = RNG.integers(0, 2, (50, 4)), RNG.integers(0, 2, (50, 4))
    truth[:, 2] = 0
    kept = [0, 1, 3]
    assert label_f1(called, truth) == pytest.approx(f1_score(truth[:, kept], called[:, kept], average="macro"))
    assert np.isnan(label_f1(called, np.zeros((50, 4))))


def test_zones_reach_into_sectors():
    assert sectors_of(None, None).tolist() == [0] * SECTORS
    assert sectors_of(np.array([0.0]), np.array([0.1])).tolist() == [1, 0, 0, 0, 0, 0, 0, 1]
    assert sectors_of(np.array([1.0, 4.0]), np.array([0.1, 0.1])).tolist() == [0, 1, 0, 0, 0, 1, 0, 0]
    assert sectors_of(np.array([3.0]), np.array([2 * np.pi])).tolist() == [1] * SECTORS


def test_an_onset_is_the_middle_of_the_first_window_that_is_called_a_rub():
    runs, edges = np.repeat(["a", "b", "c"], 4), np.tile([[0, 1], [1, 2], [2, 3], [3, 4]], (3, 1)).astype(float)
    onset = np.repeat([1.7, 3.0, np.nan], 4)
    samples = Samples({}, np.zeros(12), runs, runs, edges, onset)
    called = np.array([0, 1, 0, 1, 0, 0, 0, 0, 1, 1, 1, 1])
    assert onset_error(Outcome(called, np.zeros(12)), samples) == pytest.approx((0.2 + 1.0) / 2)
    silent = Samples({}, np.zeros(12), runs, runs, edges, np.full(12, np.nan))
    assert np.isnan(onset_error(Outcome(called, np.zeros(12)), silent))


def test_a_model_of_labels_learns_each_and_keeps_one_that_never_changes():
    features = RNG.standard_normal((120, 3))
    labels = np.column_stack([features[:, 1] > 0, np.ones(120), features[:, 2] > 0.5]).astype(int)
    for name, made in models(labels).items():
        key = "majority" if name == "majority" else name
        predicted = made.make(0).fit(features, labels, np.arange(120)).predict(features)
        assert predicted.shape == labels.shape
        assert (predicted[:, 1] == 1).all()
        if key != "majority":
            assert label_f1(predicted, labels) > 0.9


def test_random_convolutions_see_a_frequency_whatever_its_size_and_the_size_beside_it():
    assert KERNELS.shape == (84, 9)
    assert (KERNELS.sum(axis=1) == 0).all()
    time, rng = np.arange(400), np.random.default_rng(1)
    windows = [
        (size * np.sin(2 * np.pi * time / period + rng.uniform(0, 6)) + 3 * np.ones((2, 1))).astype(np.float32)
        for period in (8, 40)
        for size in (1.0, 10.0)
    ]
    rocket = fitted(np.array(windows), seeds=2)
    numbers = np.array([rocket.transform(window) for window in windows])
    assert numbers.shape == (4, 2, 2 * 2 * 84 + 4)  # two spacings are shorter than the window
    shares, levels = numbers[..., :-4], numbers[0, 0, -4:]
    same, other = np.abs(shares[0] - shares[1]).mean(), np.abs(shares[0] - shares[2]).mean()
    assert other > 5 * same
    np.testing.assert_allclose(levels, [3, 3, np.log10(np.sqrt(0.5)), np.log10(np.sqrt(0.5))], atol=1e-3)


def test_one_feature_ranks_numbers_in_either_sense_and_takes_undefined_values():
    rng = np.random.default_rng(2)
    answers, features = rng.uniform(size=100), rng.uniform(size=(100, 3))
    features[:, 1] = -answers
    features[:5, 0] = np.nan
    learned = OneFeature().fit(features, answers, np.arange(100))
    assert rank_correlation(learned.predict(features), answers) == pytest.approx(1)


def test_held_out_groups_choose_a_larger_penalty_than_held_out_windows():
    samples = _identity_only()
    names = np.eye(40)[np.repeat(np.arange(40), 8)]  # a number for each group: of use only where the group is known
    numbers = np.column_stack([names, samples.answers + RNG.standard_normal(320)]).astype(np.float32)
    by_group = Ridge(0).fit(numbers, samples.answers, samples.groups)
    by_window = Ridge(0).fit(numbers, samples.answers, np.arange(320))
    assert by_group.model.best_params_["ridge__alpha"] > by_window.model.best_params_["ridge__alpha"]


def test_ridge_ranks_by_its_last_class_and_predicts_numbers():
    numbers = RNG.standard_normal((200, 3)).astype(np.float32)
    learned = Ridge(0).fit(numbers, (numbers[:, 0] > 1).astype(int), np.arange(200))
    assert rank_correlation(learned.rank(numbers), numbers[:, 0]) > 0.95
    assert balanced_accuracy(learned.predict(numbers), (numbers[:, 0] > 1).astype(int)) > 0.9
    learned = Ridge(0).fit(numbers, numbers[:, 1].astype(float), np.arange(200))
    np.testing.assert_allclose(learned.predict(numbers), numbers[:, 1], atol=0.2)
    assert (learned.rank(numbers) == 0).all()


def test_ridge_answers_where_all_numbers_are_equal():
    numbers, answers = np.ones((40, 3), dtype=np.float32), np.arange(40) % 2
    assert set(Ridge(0).fit(numbers, answers, np.arange(40)).predict(numbers)) <= {0, 1}
    labels = np.column_stack([answers, np.ones(40)]).astype(int)
    assert (Ridge(0).fit(numbers, labels, np.arange(40)).predict(numbers)[:, 1] == 1).all()


def test_nothing_is_learned_where_no_metric_is_defined():
    def never(_seed):
        raise AssertionError("a model was made")

    samples = _identity_only()  # without an onset
    assert cross_validated(samples, Model(never), TASKS["onset"].metrics, by_group=True) == {}
    assert transferred(samples, {"other": samples}, Model(never), TASKS["onset"].metrics) == {}
