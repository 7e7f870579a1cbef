"""Score models by group, and once with a leak, to show what the leak is worth."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray, IntArray

FOLDS, SEEDS = 5, 3
"""Folds of a cross-validation, and how often it is done with other folds."""
Make = Callable[[int], Any]
Metric = Callable[[npt.NDArray[Any], npt.NDArray[Any]], float]


@dataclass(frozen=True)
class Samples:
    """Windows with their features."""

    features: FloatArray
    """(windows, features), NaN where undefined."""
    answers: npt.NDArray[Any]
    """(windows,)"""
    groups: npt.NDArray[Any]
    """(windows,): what must stay on one side."""

    def __getitem__(self, chosen: npt.NDArray[Any]) -> Samples:
        return Samples(self.features[chosen], self.answers[chosen], self.groups[chosen])


def cross_validated(samples: Samples, make: Make, metric: Metric, *, by_group: bool) -> tuple[float, float]:
    """Score a model on windows that it did not learn from: mean and standard deviation over SEEDS choices of folds.

    The predictions of all folds are scored together. With `by_group` a group is never on both sides; without, windows
    are dealt at random, which leaks.
    """
    scores = []
    for seed in range(SEEDS):
        predicted = np.empty_like(samples.answers)
        for test in folds(samples.groups if by_group else np.arange(len(samples.groups)), samples.answers, seed):
            learned = make(seed).fit(samples.features[~test], samples.answers[~test])
            predicted[test] = learned.predict(samples.features[test])
        scores.append(metric(predicted, samples.answers))
    return float(np.mean(scores)), float(np.std(scores))


def transferred(train: Samples, test: Samples, make: Make, metric: Metric) -> tuple[float, float]:
    """Learn from `train` and score on `test`: mean and standard deviation over SEEDS seeds of the model."""
    scores = []
    for seed in range(SEEDS):
        learned = make(seed).fit(train.features, train.answers)
        scores.append(metric(learned.predict(test.features), test.answers))
    return float(np.mean(scores)), float(np.std(scores))


def folds(groups: npt.NDArray[Any], answers: npt.NDArray[Any], seed: int) -> Iterator[npt.NDArray[np.bool_]]:
    """Yield which samples (samples,) each fold tests: groups are shuffled, sorted by answer and dealt to FOLDS folds.

    So each class is spread over the folds. The answer of a group is that of its first sample.
    """
    names, first, numbers = np.unique(groups, return_index=True, return_inverse=True)
    shuffled = np.random.default_rng(seed).permutation(names.size)
    order: IntArray = shuffled[np.argsort(answers[first][shuffled], kind="stable")]
    for fold in range(FOLDS):
        yield np.isin(numbers, order[fold::FOLDS])
