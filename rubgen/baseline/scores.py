"""Scores of predictions, and the best single threshold."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from rubgen.arrays import BoolArray, FloatArray

FALSE_ALARMS = 0.01
"""The share of false alarms at which a detection rate is stated."""


class Threshold(NamedTuple):
    """A threshold on one feature, and its score."""

    score: float
    """The balanced accuracy on the values that it was chosen on."""
    value: float
    above: bool
    """Whether values above it are called true."""


def best_threshold(values: FloatArray, flags: BoolArray) -> Threshold:
    """Choose the threshold on `values` (any,) with the best balanced accuracy for `flags` (any,).

    Values above it, or values below it, are then True. The threshold lies midway between two neighbouring values. The
    result has its score on these values too. Both flags must occur, and no value may be NaN.
    """
    order = np.argsort(values, kind="stable")
    ranked, sorted_flags = values[order], flags[order]
    above = 1 - np.cumsum(sorted_flags) / sorted_flags.sum()  # share of the true ones above a threshold
    below = np.cumsum(~sorted_flags) / (~sorted_flags).sum()
    allowed = np.append(ranked[1:] > ranked[:-1], False)  # no threshold fits between equal values
    scores = np.where(allowed, (above + below) / 2, 0.5)
    either = np.maximum(scores, 1 - scores)
    at = int(np.argmax(either))
    middle = ranked[at] / 2 + ranked[at + 1] / 2  # halves: the sum of two largest numbers is none
    return Threshold(float(either[at]), float(middle), bool(scores[at] >= 0.5))


def balanced_accuracy(predicted: npt.NDArray[Any], truth: npt.NDArray[Any]) -> float:
    """Compute the mean over the classes in `truth` of the share of their samples that is predicted right.

    `predicted` and `truth` (samples,) are classes. The result is NaN for fewer than two classes in `truth`.
    """
    classes = np.unique(truth)
    return (
        float(np.mean([np.mean(predicted[truth == each] == each) for each in classes])) if classes.size > 1 else np.nan
    )


def detection_rate(ranks: FloatArray, truth: npt.NDArray[Any]) -> float:
    """Compute the share of the true samples that rank above all but the share FALSE_ALARMS of the false samples.

    - ranks (any,): numbers that grow with the chance that a sample is true.
    - truth (any,): 1 for true, 0 for false.

    It is one point of the ROC curve of these ranks, so its threshold is chosen on the scored samples. NaN where one
    class is missing.
    """
    false, true = np.sort(ranks[truth == 0])[::-1], ranks[truth == 1]
    if not false.size or not true.size:
        return np.nan
    return float(np.mean(true > false[int(FALSE_ALARMS * false.size)]))


def label_f1(predicted: npt.NDArray[Any], truth: npt.NDArray[Any]) -> float:
    """Compute the mean over labels of 2 hits / (times predicted + times true). Both are (samples, labels), 0 or 1.

    Only labels that occur in `truth` count; NaN if there are none.
    """
    here = truth.any(axis=0)
    if not here.any():
        return np.nan
    hits = np.sum((predicted == 1) & (truth == 1), axis=0)
    return float(np.mean((2 * hits / np.maximum(predicted.sum(axis=0) + truth.sum(axis=0), 1))[here]))


def macro_f1(predicted: npt.NDArray[Any], truth: npt.NDArray[Any]) -> float:
    """Compute the mean over the classes in `truth` of 2 hits / (times predicted + times true).

    `predicted` and `truth` (samples,) are classes; there must be at least one sample.
    """
    classes = np.unique(truth)
    hits = np.array([np.sum((predicted == each) & (truth == each)) for each in classes])
    sizes = np.array([np.sum(predicted == each) + np.sum(truth == each) for each in classes])
    return float(np.mean(2 * hits / sizes))


def rank_correlation(predicted: FloatArray, truth: FloatArray) -> float:
    """Compute Spearman's rank correlation of `predicted` and `truth` (samples,); 0 if all values of one are equal."""
    from scipy.stats import spearmanr

    if np.ptp(predicted) == 0 or np.ptp(truth) == 0:
        return 0.0
    return float(spearmanr(predicted, truth).statistic)
