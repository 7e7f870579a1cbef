"""Models of the baselines beside their definitions, and the table that is made of their scores."""

import itertools
from types import SimpleNamespace

import numpy as np
import pytest

from rubgen.baseline.baseline import Baseline, mark_of
from rubgen.baseline.evaluate import FOLDS, SEEDS, Samples, folds
from rubgen.baseline.models import Classifier, EachLabel, Majority, OneFeature, Plain, Ridge, models
from rubgen.baseline.rocket import KERNELS, SPACINGS, TAPS, fitted
from rubgen.baseline.scores import best_threshold, detection_rate
from rubgen.baseline.table import document, table
from rubgen.baseline.tasks import TASKS, known

RNG = np.random.default_rng(11)


def test_the_majority_is_the_most_frequent_class_or_the_median():
    nothing = np.zeros((4, 0))
    classes = Majority().fit(nothing, np.array([3, 1, 3, 2]), nothing)
    assert classes.predict(np.zeros((2, 0))).tolist() == [3, 3]
    words = Majority().fit(nothing, np.array(["b", "a", "b", "c"]), nothing)
    assert words.predict(np.zeros((1, 0))).tolist() == ["b"]
    numbers = Majority().fit(nothing, np.array([1.0, 2.0, 50.0, 3.0]), nothing)
    assert numbers.predict(np.zeros((3, 0))).tolist() == [2.5] * 3
    assert numbers.rank(np.zeros((3, 0))).tolist() == [0.0] * 3


def brute_threshold(values, flags):
    """The best balanced accuracy over all places between two values, and both senses."""
    ordered = np.unique(values)
    best = 0.5
    for cut in (ordered[1:] + ordered[:-1]) / 2:
        right = ((values > cut)[flags].mean() + (values <= cut)[~flags].mean()) / 2
        best = max(best, right, 1 - right)
    return best


def test_the_best_threshold_is_that_of_trying_them_all():
    """Values that occur several times too: no threshold parts equal values."""
    for _ in range(40):
        values = RNG.integers(0, 6, 25).astype(float)
        flags = RNG.integers(0, 2, 25).astype(bool)
        flags[:2] = True, False
        found = best_threshold(values, flags)
        assert found.score == pytest.approx(brute_threshold(values, flags))
        said = (values > found.value) == found.above
        if found.score > 0.5:
            assert (said[flags].mean() + (~said)[~flags].mean()) / 2 == pytest.approx(found.score)


def test_one_feature_calls_the_class_by_its_threshold_in_either_sense():
    features = np.column_stack([RNG.normal(size=60), np.repeat([1.0, 5.0], 30), np.full(60, np.nan)])
    for answers in (np.repeat([0, 1], 30), np.repeat([1, 0], 30)):
        learned = OneFeature().fit(features, answers, answers)
        assert (learned.feature, learned.threshold) == (1, 3.0)
        np.testing.assert_array_equal(learned.predict(features), answers)
        assert learned.rank(features)[answers == 1].min() > learned.rank(features)[answers == 0].max()
    numbers = OneFeature().fit(features, features[:, 1], answers)
    np.testing.assert_array_equal(numbers.predict(features), features[:, 1])


def test_all_classes_count_the_same_however_rare():
    """The largest ratio of a class's probability to its share: 0.3 of a class of a tenth beats 0.7 of nine tenths."""
    said = np.array([[0.7, 0.3], [0.95, 0.05], [0.5, 0.5]])
    classes = np.array(["common", "rare"])
    model = SimpleNamespace(fit=lambda *_: None, classes_=classes, predict_proba=lambda _: said)
    learned = Classifier(model).fit(np.zeros((10, 1)), np.array(["common"] * 9 + ["rare"]), np.zeros(10))
    assert learned.predict(np.zeros((3, 1))).tolist() == ["rare", "common", "rare"]
    assert learned.rank(np.zeros((3, 1))).tolist() == [0.3, 0.05, 0.5]


def test_ridge_is_least_squares_with_the_penalty_it_chose():
    """Standardized numbers, the closed form with an intercept, and classes by targets scaled to 0 and 1 in the mean."""
    numbers = RNG.normal(size=(80, 4)) * [1, 10, 0.1, 3] + [0, 5, -1, 2]
    answers = np.digitize(numbers[:, 0] + 0.3 * RNG.normal(size=80), [-0.4, 0.4])
    learned = Ridge(0).fit(numbers, answers, np.arange(80))
    penalty = learned.model.best_params_["ridge__alpha"]
    X = (numbers - numbers.mean(axis=0)) / numbers.std(axis=0)
    targets = (answers[:, None] == np.arange(3)).astype(float)
    means = targets.mean(axis=0)
    weights = np.linalg.solve(X.T @ X + penalty * np.eye(4), X.T @ (targets - means))
    said = means + X @ weights
    np.testing.assert_allclose(learned.rank(numbers), said[:, -1], rtol=1e-8)
    zero = np.array([said[targets[:, c] == 0, c].mean() for c in range(3)])
    one = np.array([said[targets[:, c] == 1, c].mean() for c in range(3)])
    np.testing.assert_array_equal(learned.predict(numbers), np.argmax((said - zero) / (one - zero), axis=1))


def test_each_kind_of_answer_has_its_models():
    two, three, numbers = np.array([0, 1]), np.array([0, 1, 2]), np.array([0.5, 1.5])
    made = {name: model.make(0) for name, model in models(two).items()}
    assert list(made) == ["majority", "one threshold", "boosting", "rocket"]
    assert [type(each) for each in made.values()] == [Majority, OneFeature, Classifier, Ridge]
    assert type(models(three)["one threshold"].make(0)) is Plain
    assert [type(models(numbers)[name].make(0)) for name in ("one threshold", "boosting")] == [OneFeature, Plain]
    labels = models(np.zeros((2, 3)))
    assert [type(model.make(0)) for model in labels.values()] == [EachLabel, EachLabel, EachLabel, Ridge]
    assert [labels[name].inputs(2) for name in labels] == ["features", "features", "features", "rocket 2"]


def test_no_fold_is_lost_where_groups_are_few():
    groups = np.array([5, 5, 7, 9, 9, 9])
    tested = np.array(list(folds(groups, np.array([0, 0, 1, 0, 0, 0]), seed=2)))
    assert tested.shape == (FOLDS, 6)
    assert (tested.sum(axis=0) == 1).all()
    assert sorted(tested.sum(axis=1).tolist()) == [0, 0, 1, 2, 3]


def test_one_false_alarm_in_a_few_samples_is_above_the_share():
    ranks, truth = np.array([0.1, 0.9, 0.5, 0.95, 0.9]), np.array([0, 0, 1, 1, 1])
    assert detection_rate(ranks, truth) == pytest.approx(1 / 3)  # 0.95 alone lies above all of the false ones


def test_windows_without_an_answer_do_not_count():
    assert known(np.array([0, 1, -1, 3])).tolist() == [True, True, False, True]
    assert known(np.array([0.0, np.nan, -2.5, np.inf])).tolist() == [True, False, True, False]
    assert known(np.zeros((2, 8))).tolist() == [True, True]


def test_kernels_are_all_choices_of_three_of_nine_taps_once():
    assert {tuple(np.flatnonzero(kernel == 2)) for kernel in KERNELS} == set(itertools.combinations(range(TAPS), 3))
    assert np.unique(KERNELS).tolist() == [-1.0, 2.0]


def test_shares_are_those_of_numpys_convolution_and_spacings_fit_the_window():
    """MiniRocket: the share of samples at which a dilated convolution with zeros around is above its bias."""
    window = RNG.normal(size=(2, 300)).astype(np.float32)
    rocket = fitted(window[None], seeds=2)
    assert rocket.spacings == tuple(each for each in SPACINGS if (TAPS - 1) * each < 300)
    assert fitted(window[None, :, :65], seeds=1).spacings == (1, 8)
    assert fitted(window[None, :, :64], seeds=1).spacings == (1,)
    numbers = rocket.transform(window)
    for channel, place, kernel, seed in ((0, 0, 0, 0), (1, 1, 83, 1), (1, 0, 40, 0)):
        dilated = np.zeros((TAPS - 1) * rocket.spacings[place] + 1)
        dilated[:: rocket.spacings[place]] = KERNELS[kernel]
        scaled = (window[channel] - window[channel].mean()) / window[channel].std()
        convolved = np.convolve(scaled, dilated[::-1], mode="same")
        share = np.mean(convolved > rocket.biases[channel, place, kernel, seed])
        column = (channel * len(rocket.spacings) + place) * len(KERNELS) + kernel
        assert numbers[seed, column] == pytest.approx(share, abs=2 / 300)
    shares = numbers[:, : 2 * 2 * len(KERNELS)]
    assert shares.mean() == pytest.approx(0.5, abs=0.03)  # biases are quantiles, evenly spread


def test_the_table_has_a_cell_for_each_way_and_a_line_for_each_mark():
    metric = next(iter(TASKS["rub"].metrics))
    found = {
        "majority": {"by group": {metric: (0.5, 0.0)}, "on far": {}},
        "boosting": {"by group": {metric: (0.876, 0.014)}, "leaky": {metric: (0.99, 0.0)}},
    }
    text = table([Baseline("rub", 80, 20, found, "one threshold solves it")])
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("|")]
    assert rows[0] == ["task", "metric", "model", "by group", "on far", "leaky"]
    assert ["rub", metric, "majority", "0.50 ± 0.00", "", ""] in rows
    assert ["rub", metric, "boosting", "0.88 ± 0.01", "", "0.99 ± 0.00"] in rows
    assert text.splitlines()[-2:] == [
        "- rub: learned from 80 windows of 20 groups", "- rub: one threshold solves it",
    ]  # fmt: skip
    written = document("set", "ab" * 32, [Baseline("rub", 80, 20, found, "")], {"onset": "no run begins to rub"})
    assert (written["folds"], written["seeds"]) == (FOLDS, SEEDS)
    assert written["tasks"][0]["scores"]["boosting"]["leaky"] == {metric: (0.99, 0.0)}
    assert written["not_possible"] == {"onset": "no run begins to rub"}


def test_a_task_is_marked_by_its_first_way_with_a_score():
    """Without a score by group the first split counts; without any score there is no mark."""
    metric = next(iter(TASKS["rub"].metrics))

    def ways(**given):
        return {way.replace("_", " "): {metric: (score, 0.0)} if score else {} for way, score in given.items()}

    found = {"majority": ways(on_far=0.5), "one threshold": ways(on_far=0.97), "boosting": ways(on_far=0.98)}
    assert mark_of(found, TASKS["rub"]) == "one threshold solves it (0.97 > 0.95)"
    found["one threshold"] = ways(on_far=0.95)
    assert mark_of(found, TASKS["rub"]) == ""
    assert mark_of({name: {} for name in found}, TASKS["rub"]) == ""


def test_chosen_windows_keep_all_that_belongs_to_them():
    samples = Samples(
        {"features": np.arange(6.0).reshape(3, 2)}, np.array([1, 0, 1]), np.array(list("abc")), np.array(list("xyz")),
        np.arange(6.0).reshape(3, 2), np.array([0.1, np.nan, 0.3]),
    )  # fmt: skip
    part = samples[np.array([True, False, True])]
    assert part.inputs["features"].tolist() == [[0, 1], [4, 5]]
    assert [part.answers.tolist(), part.groups.tolist(), part.runs.tolist()] == [[1, 1], ["a", "c"], ["x", "z"]]
    assert [part.edges.tolist(), part.onset.tolist()] == [[[0, 1], [4, 5]], [0.1, 0.3]]
