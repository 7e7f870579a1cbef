"""Score models by group, and once with a leak, to show what the leak is worth."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray, IntArray
from rubgen.baseline.models import Model

FOLDS, SEEDS = 5, 3
"""Folds of a cross-validation, and how often it is done with other folds."""


@dataclass(frozen=True)
class Samples:
    """Windows with their inputs, answers, groups and runs. All arrays have a row for each window."""

    inputs: Mapping[str, FloatArray]
    answers: npt.NDArray[Any]
    groups: npt.NDArray[Any]
    """What must stay on one side."""
    runs: npt.NDArray[Any]
    edges: FloatArray
    """Start and end in s from the first sample of the run's signals (windows, 2)."""
    onset: FloatArray
    """When the run's rub begins, in s from its first sample; NaN where it does not begin within the signals."""

    def __getitem__(self, chosen: npt.NDArray[Any]) -> Samples:
        parts = {each.name: getattr(self, each.name) for each in fields(self) if each.name != "inputs"}
        inputs = {name: values[chosen] for name, values in self.inputs.items()}
        return Samples(inputs=inputs, **{name: values[chosen] for name, values in parts.items()})


class Outcome(NamedTuple):
    """The predictions of a model for windows."""

    answers: npt.NDArray[Any]
    ranks: FloatArray
    """Numbers that grow with the chance of the last class, of two classes; without meaning for other answers."""


Metrics = Mapping[str, Callable[[Outcome, Samples], float]]
Scores = dict[str, tuple[float, float]]
"""Mean and standard deviation over the seeds, by metric. A metric that is undefined there is left out."""


def cross_validated(samples: Samples, model: Model, metrics: Metrics, *, by_group: bool) -> Scores:
    """Score a model on windows that it did not learn from, SEEDS times with different folds.

    Returns mean and standard deviation over the seeds of each metric, by its name. The predictions of all folds are
    scored together by `metrics`. With `by_group` a group is never on both sides. Without it windows are assigned to
    folds at random, so that windows of one run are on both sides, which leaks. A metric that is undefined on these
    samples is left out. If all are, nothing is learned.
    """
    if not _any_defined(metrics, samples):
        return {}

    def outcome(seed: int) -> Outcome:
        found = Outcome(np.empty_like(samples.answers), np.zeros(len(samples.groups)))
        owners = samples.groups if by_group else np.arange(len(samples.groups))
        for test in folds(owners, samples.answers, seed):
            learned = _learned(samples[~test], model, seed, owners[~test])
            part = _said(learned, samples[test], model, seed)
            found.answers[test], found.ranks[test] = part
        return found

    return _scores([outcome(seed) for seed in range(SEEDS)], samples, metrics)


def transferred(train: Samples, tests: Mapping[str, Samples], model: Model, metrics: Metrics) -> dict[str, Scores]:
    """Learn from `train` with SEEDS seeds of the model, and score on each of `tests` by `metrics`.

    Returns the scores by the name of the test, each as in `cross_validated`. A model learns once a seed, for all tests.
    Tests where no metric is defined are left out.
    """
    tests = {name: test for name, test in tests.items() if _any_defined(metrics, test)}
    if not tests:
        return {}
    outcomes: dict[str, list[Outcome]] = {name: [] for name in tests}
    for seed in range(SEEDS):
        learned = _learned(train, model, seed, train.groups)
        for name, test in tests.items():
            outcomes[name].append(_said(learned, test, model, seed))
    return {name: _scores(outcomes[name], test, metrics) for name, test in tests.items()}


def folds(groups: npt.NDArray[Any], answers: npt.NDArray[Any], seed: int) -> Iterator[npt.NDArray[np.bool_]]:
    """Yield a mask (samples,) for each of FOLDS folds: the samples that it tests. Every sample is tested in one fold.

    The groups are shuffled by `seed`, sorted by answer, and dealt to the folds one after another. This spreads each
    class over the folds. All samples of a group are in one fold. With fewer groups than FOLDS some folds are empty.

    - groups (samples,): group of each sample.
    - answers (samples,): answer of each sample; a group has the answer of its first sample. For labels (samples,
      labels) the groups are shuffled, but not sorted.
    """
    names, first, numbers = np.unique(groups, return_index=True, return_inverse=True)
    shuffled = np.random.default_rng(seed).permutation(names.size)
    order: IntArray = shuffled
    if answers.ndim == 1:
        order = shuffled[np.argsort(answers[first][shuffled], kind="stable")]
    for fold in range(FOLDS):
        yield np.isin(numbers, order[fold::FOLDS])


def _any_defined(metrics: Metrics, samples: Samples) -> bool:
    """Return whether the right answers of these samples have a score by any metric."""
    right = Outcome(samples.answers, np.zeros(len(samples.groups)))
    return any(np.isfinite(metric(right, samples)) for metric in metrics.values())


def _learned(train: Samples, model: Model, seed: int, groups: npt.NDArray[Any]) -> Any:
    return model.make(seed).fit(train.inputs[model.inputs(seed)], train.answers, groups)


def _said(learned: Any, test: Samples, model: Model, seed: int) -> Outcome:
    inputs = test.inputs[model.inputs(seed)]
    return Outcome(learned.predict(inputs), learned.rank(inputs))


def _scores(found: Sequence[Outcome], samples: Samples, metrics: Metrics) -> Scores:
    scores = {name: [metric(each, samples) for each in found] for name, metric in metrics.items()}
    return {
        name: (float(np.mean(each)), float(np.std(each))) for name, each in scores.items() if np.isfinite(each).all()
    }
