"""Scores: what chance reaches with the best threshold, and gradient boosting with folds by run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from threadpoolctl import threadpool_limits

from rubgen.arrays import FloatArray
from rubgen.baseline.scores import balanced_accuracy, best_threshold

Flags = npt.NDArray[np.bool_]
FOLDS = 5
SEEDS = 3
"""Each with other folds; their scores give mean and standard deviation."""


def chance_level(rub: Flags, *, tries: int = 1000) -> float:
    """The score of `best_threshold` that a feature without information reaches in 95 % of cases."""
    noise = np.random.default_rng(0).standard_normal((tries, rub.size))
    return float(np.quantile([best_threshold(values, rub).score for values in noise], 0.95))


@dataclass(frozen=True, kw_only=True)
class Boosted:
    """Predictions of gradient boosting, each for a run that its fold did not learn from."""

    predicted: Flags
    """Of each seed (seeds, runs)."""
    rub: Flags
    """The truth (runs,)."""

    def accuracy(self, chosen: Flags | None = None) -> tuple[float, float]:
        """Mean and standard deviation over the seeds of the balanced accuracy; NaN where a class is missing."""
        where = np.ones(self.rub.size, dtype=bool) if chosen is None else chosen
        scores = [balanced_accuracy(each[where], self.rub[where]) for each in self.predicted]
        return float(np.mean(scores)), float(np.std(scores))

    def called_rub(self, chosen: Flags) -> float:
        """The share of the chosen runs that are called a rub; NaN without any."""
        return float(self.predicted[:, chosen].mean()) if chosen.any() else float("nan")


def boosted(features: FloatArray, rub: Flags) -> Boosted:
    """Gradient boosting on features (runs, any), with folds by run that have equal shares of rubs."""
    from sklearn.ensemble import HistGradientBoostingClassifier
    from sklearn.model_selection import StratifiedKFold, cross_val_predict

    predicted = []
    for seed in range(SEEDS):
        folds = StratifiedKFold(FOLDS, shuffle=True, random_state=seed)
        model = HistGradientBoostingClassifier(class_weight="balanced", random_state=seed)
        with threadpool_limits(1):
            predicted.append(cross_val_predict(model, features, rub, cv=folds))
    return Boosted(predicted=np.array(predicted, dtype=bool), rub=rub)
