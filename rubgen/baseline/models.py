"""The models of the baselines. All take features (samples, features) with NaN and have `fit` and `predict`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray
from rubgen.baseline.scores import best_threshold, rank_correlation

Answer = npt.NDArray[Any]


class Majority:
    """Answers the most frequent class, or the median of numbers."""

    def fit(self, _features: FloatArray, answers: Answer) -> Self:
        """Learn from answers (samples,)."""
        if answers.dtype.kind == "f":
            self.answer: Any = float(np.median(answers))
        else:
            classes, counts = np.unique(answers, return_counts=True)
            self.answer = classes[np.argmax(counts)]
        return self

    def predict(self, features: FloatArray) -> Answer:
        """Answer for each sample."""
        return np.full(len(features), self.answer)


class OneFeature:
    """The best single feature: a threshold for two classes, the ranks for numbers. NaN counts as the smallest value."""

    def fit(self, features: FloatArray, answers: Answer) -> Self:
        """Choose feature, threshold and sense on features (samples, features) and answers (samples,)."""
        known = _finite(features)
        if answers.dtype.kind == "f":
            scores = [rank_correlation(values, answers) for values in known.T]
            self.feature = int(np.argmax(np.abs(scores)))
            self.sense, self.threshold = np.sign(scores[self.feature]), None
            return self
        self.classes = np.unique(answers)
        found = [best_threshold(values, answers == self.classes[-1]) for values in known.T]
        self.feature = int(np.argmax([each.score for each in found]))
        self.threshold, self.sense = found[self.feature].value, found[self.feature].above
        return self

    def predict(self, features: FloatArray) -> Answer:
        """Answer for each sample."""
        values = _finite(features)[:, self.feature]
        if self.threshold is None:
            return np.asarray(self.sense * values)
        return np.asarray(np.where((values > self.threshold) == self.sense, self.classes[-1], self.classes[0]))


class BoostedClasses:
    """scikit-learn's histogram gradient boosting with its default settings; each class counts the same.

    The class with the largest ratio of its probability to its share among the learned ones is the answer. Weights of
    classes would do the same, but with them scikit-learn 1.9 takes 12 s to bin 320 samples of 348 features.
    """

    def __init__(self, seed: int) -> None:
        self.seed = seed

    def fit(self, features: FloatArray, answers: Answer) -> Self:
        """Learn from features (samples, features) and answers (samples,)."""
        from sklearn.ensemble import HistGradientBoostingClassifier

        self.model = HistGradientBoostingClassifier(random_state=self.seed).fit(features, answers)
        self.shares = np.array([np.mean(answers == each) for each in self.model.classes_])
        return self

    def predict(self, features: FloatArray) -> Answer:
        """Answer for each sample."""
        return np.asarray(self.model.classes_[np.argmax(self.model.predict_proba(features) / self.shares, axis=1)])


def boosting(seed: int, *, numbers: bool) -> Any:
    """Make gradient boosting for numbers or for classes."""
    from sklearn.ensemble import HistGradientBoostingRegressor

    return HistGradientBoostingRegressor(random_state=seed) if numbers else BoostedClasses(seed)


def one_split(seed: int) -> Any:
    """Make scikit-learn's decision tree with a single split: one threshold for several classes."""
    from sklearn.tree import DecisionTreeClassifier

    return DecisionTreeClassifier(max_depth=1, class_weight="balanced", random_state=seed)


def models(*, numbers: bool, classes: int) -> dict[str, Callable[[int], Any]]:
    """Return the models of a task by their name, each as a function of a seed."""
    return {
        "majority": lambda _seed: Majority(),
        "one threshold": one_split if classes > 2 and not numbers else lambda _seed: OneFeature(),
        "boosting": lambda seed: boosting(seed, numbers=numbers),
    }


def _finite(features: FloatArray) -> FloatArray:
    return np.nan_to_num(features, nan=-np.finfo(np.float64).max, posinf=None, neginf=None)
