"""The models of the baselines. All have `fit(numbers, answers)`, `predict(numbers)` and `rank(numbers)`.

Numbers are (samples, any), answers (samples,), or labels of 0 and 1 (samples, labels). `rank` grows with the chance of
the last of two classes, and is 0 for all other answers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray
from rubgen.baseline.scores import best_threshold, rank_correlation

Answer = npt.NDArray[Any]
BOOSTING = {"max_iter": 50, "max_leaf_nodes": 8}
"""A third of the time of the defaults: a task of labels learns some hundred of these."""


class Majority:
    """Predicts the most frequent class, or the median of numbers."""

    def fit(self, _features: FloatArray, answers: Answer) -> Self:
        """Store the most frequent class of `answers` (samples,), or the median of numbers."""
        if answers.dtype.kind == "f":
            self.answer: Any = float(np.median(answers))
        else:
            classes, counts = np.unique(answers, return_counts=True)
            self.answer = classes[np.argmax(counts)]
        return self

    def predict(self, features: FloatArray) -> Answer:
        """Return the stored answer for each row of `features`."""
        return np.full(len(features), self.answer)

    def rank(self, features: FloatArray) -> FloatArray:
        """Return rank 0 for each sample."""
        return np.zeros(len(features))


class OneFeature:
    """The best single feature: a threshold for two classes, its values as ranks for numbers.

    NaN is the smallest value.
    """

    def fit(self, features: FloatArray, answers: Answer) -> Self:
        """Choose the feature, its threshold, and its sense: 1 if the feature grows with the answers, -1 if it falls.

        `features` are (samples, features), `answers` (samples,).
        """
        finite = _finite(features)
        if answers.dtype.kind == "f":
            scores = [rank_correlation(values, answers) for values in finite.T]
            self.feature = int(np.argmax(np.abs(scores)))
            self.sense, self.threshold = np.sign(scores[self.feature]), None
            return self
        self.classes = np.unique(answers)
        found = [best_threshold(values, answers == self.classes[-1]) for values in finite.T]
        self.feature = int(np.argmax([each.score for each in found]))
        self.threshold, self.sense = found[self.feature].value, 1.0 if found[self.feature].above else -1.0
        return self

    def predict(self, features: FloatArray) -> Answer:
        """Return the class of each row of `features`, by the threshold. For numbers return the row's rank."""
        if self.threshold is None:
            return self.rank(features)
        above = _finite(features)[:, self.feature] > self.threshold
        return np.asarray(np.where(above == (self.sense > 0), self.classes[-1], self.classes[0]))

    def rank(self, features: FloatArray) -> FloatArray:
        """Return for each row of `features` the value of the chosen feature, times its sense (1 or -1)."""
        return np.asarray(self.sense * _finite(features)[:, self.feature])


class Classifier:
    """A classifier of scikit-learn in which all classes count the same.

    The answer is the class with the largest ratio of its probability to its share among the learned classes. Weights of
    classes would do the same, but with them scikit-learn 1.9 takes 12 s to bin 320 samples of 348 features.
    """

    def __init__(self, model: Any) -> None:
        self.model = model

    def fit(self, features: FloatArray, answers: Answer) -> Self:
        """Learn from features (samples, features) and the classes (samples,)."""
        self.model.fit(features, answers)
        self.shares = np.array([np.mean(answers == each) for each in self.model.classes_])
        return self

    def predict(self, features: FloatArray) -> Answer:
        """Return the class of each sample."""
        return np.asarray(self.model.classes_[np.argmax(self.model.predict_proba(features) / self.shares, axis=1)])

    def rank(self, features: FloatArray) -> FloatArray:
        """Return the probability of the last class of each sample."""
        return np.asarray(self.model.predict_proba(features)[:, -1])


class Plain:
    """A model of scikit-learn without any change."""

    def __init__(self, model: Any) -> None:
        self.model = model

    def fit(self, numbers: FloatArray, answers: Answer) -> Self:
        """Learn from `numbers` (samples, numbers) and the answers (samples,)."""
        self.model.fit(numbers, answers)
        return self

    def predict(self, numbers: FloatArray) -> Answer:
        """Return the answer of each sample."""
        return np.asarray(self.model.predict(numbers))

    def rank(self, numbers: FloatArray) -> FloatArray:
        """Return the distance of each sample from the plane between two classes, or 0 for a model that has no plane."""
        decide = getattr(self.model, "decision_function", None)
        found = np.asarray(decide(numbers)) if decide else np.zeros(len(numbers))
        return found if found.ndim == 1 else np.zeros(len(numbers))


class EachLabel:
    """One model of two classes for each label.

    A label that was the same in all learned samples is always predicted so.
    """

    def __init__(self, make: Callable[[], Any]) -> None:
        self.make = make

    def fit(self, features: FloatArray, answers: Answer) -> Self:
        """Learn one model for each column of `answers` (samples, labels), from `features` (samples, features)."""
        self.models = [(self.make() if np.ptp(labels) else Majority()).fit(features, labels) for labels in answers.T]
        return self

    def predict(self, features: FloatArray) -> Answer:
        """Return the labels, 0 or 1, of each row of `features`, as (samples, labels)."""
        return np.column_stack([each.predict(features) for each in self.models])

    def rank(self, features: FloatArray) -> FloatArray:
        """Return rank 0 for each sample."""
        return np.zeros(len(features))


@dataclass(frozen=True)
class Model:
    """A kind of model: a function that makes it, and the name of its inputs, both by the seed."""

    make: Callable[[int], Any]
    inputs: Callable[[int], str] = lambda _seed: "features"


def models(answers: Answer) -> dict[str, Model]:
    """Return the models by name for answers of this kind: classes, numbers, or labels (samples, labels)."""
    if answers.ndim == 2:
        return {name: _each_label(model) for name, model in models(np.array([0, 1])).items()}
    numbers = answers.dtype.kind == "f"
    threshold = _one_split if not numbers and np.unique(answers).size > 2 else lambda _seed: OneFeature()
    return {
        "majority": Model(lambda _seed: Majority()),
        "one threshold": Model(threshold),
        "boosting": Model(_boosted_numbers if numbers else _boosted_classes),
        "rocket": Model(lambda _seed: _ridge(numbers=numbers), lambda seed: f"rocket {seed}"),
    }


def _each_label(model: Model) -> Model:
    return Model(lambda seed: EachLabel(lambda: model.make(seed)), model.inputs)


def _boosted_classes(seed: int) -> Classifier:
    from sklearn.ensemble import HistGradientBoostingClassifier

    return Classifier(HistGradientBoostingClassifier(**BOOSTING, random_state=seed))


def _boosted_numbers(seed: int) -> Plain:
    from sklearn.ensemble import HistGradientBoostingRegressor

    return Plain(HistGradientBoostingRegressor(**BOOSTING, random_state=seed))


def _one_split(seed: int) -> Plain:
    """Make a decision tree with a single split: one threshold for several classes."""
    from sklearn.tree import DecisionTreeClassifier

    return Plain(DecisionTreeClassifier(max_depth=1, class_weight="balanced", random_state=seed))


def _ridge(*, numbers: bool) -> Plain:
    """Make a ridge regression on standardized numbers, whose penalty is chosen by leaving samples out."""
    from sklearn.linear_model import RidgeClassifierCV, RidgeCV
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    penalties = np.logspace(-3, 5, 9)
    ridge = RidgeCV(penalties) if numbers else RidgeClassifierCV(penalties, class_weight="balanced")
    return Plain(make_pipeline(StandardScaler(), ridge))


def _finite(features: FloatArray) -> FloatArray:
    return np.nan_to_num(features, nan=-np.finfo(np.float64).max, posinf=None, neginf=None)
