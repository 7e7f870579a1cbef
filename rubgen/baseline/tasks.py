"""The tasks of a data set: what is to be learned, on which runs, and how it is scored."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from rubgen.baseline.scores import balanced_accuracy, macro_f1, rank_correlation
from rubgen.dataset.reading.answers import Answers
from rubgen.dataset.reading.open import DataSet


@dataclass(frozen=True)
class Task:
    """One task."""

    target: str
    """Column of the answer."""
    metric: str
    score: Callable[[npt.NDArray[Any], npt.NDArray[Any]], float]
    of_rubs: bool
    """Whether only runs that rub count."""

    def runs(self, data: DataSet) -> list[str]:
        """Return the good runs whose answer is defined."""
        good = data.ok
        chosen = good[good["rub"].astype(bool)] if self.of_rubs else good
        names = [str(name) for name in chosen.index]
        if not names:
            return []
        answers = self.answers(data, names)
        return [name for name, answer in zip(names, answers, strict=True) if np.isfinite(answer) and answer != -1]

    def answers(self, data: DataSet, runs: list[str]) -> npt.NDArray[Any]:
        """Return the answer of each run: an integer for a class, else a float."""
        return Answers(data, self.target).of_runs(runs)


TASKS = {
    "rub": Task("rub", "balanced accuracy", balanced_accuracy, of_rubs=False),
    "motion": Task("motion", "macro-F1", macro_f1, of_rubs=True),
    "severity": Task("contact_severity", "rank correlation", rank_correlation, of_rubs=True),
}
"""`rubgen baseline --task`: motion and severity are those of runs that rub."""
