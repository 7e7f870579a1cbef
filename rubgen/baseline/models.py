"""The models of the baselines. All have `fit(numbers, answers, groups)`, `predict(numbers)` and `rank(numbers)`.

Numbers are (samples, any), answers (samples,), or labels of 0 and 1 (samples, labels). Samples of one group (samples,)
belong together. `rank` grows with the chance of the last of two classes. It has no meaning for other answers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from rubgen.arrays import BoolArray, FloatArray
from rubgen.baseline.scores import best_threshold, rank_correlation
from rubgen.measurement.channel import Float32Array

Answer = npt.NDArray[Any]
Groups = npt.NDArray[Any]
BOOSTING = {"max_iter": 50, "max_leaf_nodes": 8}
"""A third of the time of the defaults: a task of labels learns some hundred of these."""
PENALTIES = (1e1, 1e2, 1e3, 1e4, 1e5)
HELD_OUT = 0.2
"""Share of the groups that choose the penalty of a ridge regression."""


class Majority:
    """Predicts the most frequent class, or the median of numbers."""

    def fit(self, _features: FloatArray, answers: Answer, _groups: Groups) -> Self:
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

    def fit(self, features: FloatArray, answers: Answer, _groups: Groups) -> Self:
        """Choose the feature, its threshold, and its sense: 1 if the feature grows with the answers, -1 if it falls.

        `features` are (samples, features), `answers` (samples,). For two classes the feature has the largest balanced
        accuracy on these samples. For numbers it has the largest size of the rank correlation with the answers.
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

    def fit(self, features: FloatArray, answers: Answer, _groups: Groups) -> Self:
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
    """A model of scikit-learn without any change, whose ranks are 0."""

    def __init__(self, model: Any) -> None:
        self.model = model

    def fit(self, numbers: FloatArray, answers: Answer, _groups: Groups) -> Self:
        """Learn from `numbers` (samples, numbers) and the answers (samples,)."""
        self.model.fit(numbers, answers)
        return self

    def predict(self, numbers: FloatArray) -> Answer:
        """Return the answer of each sample."""
        return np.asarray(self.model.predict(numbers))

    def rank(self, numbers: FloatArray) -> FloatArray:
        """Return rank 0 for each sample."""
        return np.zeros(len(numbers))


class Ridge:
    """A ridge regression on standardized numbers, for numbers, classes or labels.

    A class or a label is a target that is 1 where a sample has it, else 0. Predicted targets are scaled so that their
    mean over the learned samples is 1 for samples that have it and 0 for others. A label is predicted where its scaled
    target is above 0.5. The class of a sample is the one with the largest scaled target.

    The penalty is the one of PENALTIES with the least squared error on groups that are held out. Held-out windows of
    learned groups would choose a penalty too small, with which the model knows its groups again.
    """

    def __init__(self, seed: int) -> None:
        self.seed = seed

    def fit(self, numbers: Float32Array, answers: Answer, groups: Groups) -> Self:
        """Learn from `numbers` (samples, numbers), the answers and the groups."""
        from sklearn.linear_model import Ridge as Regression
        from sklearn.model_selection import GridSearchCV, GroupShuffleSplit
        from sklearn.pipeline import make_pipeline
        from sklearn.preprocessing import StandardScaler

        classes = answers.ndim == 1 and answers.dtype.kind != "f"
        self.classes = np.unique(answers) if classes else None
        targets = np.asarray(answers if self.classes is None else answers[:, None] == self.classes, numbers.dtype)
        self.model = GridSearchCV(
            make_pipeline(StandardScaler(), Regression(solver="cholesky")),
            {"ridge__alpha": PENALTIES},
            scoring="neg_mean_squared_error",
            cv=GroupShuffleSplit(1, test_size=HELD_OUT, random_state=self.seed),
        ).fit(numbers, targets, groups=groups)
        if targets.ndim == 2:
            said = self.model.predict(numbers)
            self.zero, one = _means(said, targets == 0, absent=0), _means(said, targets == 1, absent=1)
            self.spread = np.where(one > self.zero, one - self.zero, np.inf)  # equal numbers tell no sample apart
        return self

    def predict(self, numbers: Float32Array) -> Answer:
        """Return the answer of each sample."""
        found = np.asarray(self.model.predict(numbers))
        if found.ndim == 1:
            return found
        scaled = (found - self.zero) / self.spread
        return (scaled > 0.5).astype(np.int64) if self.classes is None else self.classes[np.argmax(scaled, axis=1)]

    def rank(self, numbers: Float32Array) -> FloatArray:
        """Return the target of the last class of each sample, or 0 for numbers and labels."""
        if self.classes is None:
            return np.zeros(len(numbers))
        return np.asarray(self.model.predict(numbers)[:, -1], dtype=np.float64)


class EachLabel:
    """One model of two classes for each label.

    A label that was the same in all learned samples is always predicted so.
    """

    def __init__(self, make: Callable[[], Any]) -> None:
        self.make = make

    def fit(self, features: FloatArray, answers: Answer, groups: Groups) -> Self:
        """Learn one model for each column of `answers` (samples, labels), from `features` (samples, features)."""
        made = ((self.make() if np.ptp(labels) else Majority(), labels) for labels in answers.T)
        self.models = [each.fit(features, labels, groups) for each, labels in made]
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
    """Return the models by name for answers of this kind: classes, numbers, or labels (samples, labels).

    The names are "majority", "one threshold", "boosting" and "rocket", in this order.
    """
    rocket = Model(Ridge, lambda seed: f"rocket {seed}")
    if answers.ndim == 2:
        return {name: _each_label(model) for name, model in _of_features(np.array([0, 1])).items()} | {"rocket": rocket}
    return _of_features(answers) | {"rocket": rocket}


def _of_features(answers: Answer) -> dict[str, Model]:
    numbers = answers.dtype.kind == "f"
    threshold = _one_split if not numbers and np.unique(answers).size > 2 else lambda _seed: OneFeature()
    return {
        "majority": Model(lambda _seed: Majority()),
        "one threshold": Model(threshold),
        "boosting": Model(_boosted_numbers if numbers else _boosted_classes),
    }


def _each_label(model: Model) -> Model:
    return Model(lambda seed: EachLabel(lambda: model.make(seed)))


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


def _means(values: Float32Array, chosen: BoolArray, absent: float) -> FloatArray:
    """Return the mean of the chosen values of each column, or `absent` for a column without any."""
    return np.array(
        [column[here].mean() if here.any() else absent for column, here in zip(values.T, chosen.T, strict=True)]
    )


def _finite(features: FloatArray) -> FloatArray:
    return np.nan_to_num(features, nan=-np.finfo(np.float64).max, posinf=None, neginf=None)
