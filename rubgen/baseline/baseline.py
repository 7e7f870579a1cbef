"""The baselines of a data set, with what they say of its tasks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import numpy.typing as npt
from threadpoolctl import threadpool_limits

from rubgen.baseline.evaluate import FOLDS, Samples, cross_validated, transferred
from rubgen.baseline.models import models
from rubgen.baseline.tasks import TASKS, Task
from rubgen.dataset.reading.open import DataSet
from rubgen.errors import UserError
from rubgen.features.plan import IDS
from rubgen.features.write import write_features
from rubgen.machine.problems import nearest

WINDOWS = 4
"""Windows that each signal is cut into: a leak needs several of one run."""
TRAIN = "train"
SOLVED, NOTHING = 0.95, 0.6
"""A task that one threshold scores higher on is too easy; one that no model scores so much on teaches nothing."""
LEAKY = "boosting"
"""The model whose leaky score is made too."""


@dataclass(frozen=True)
class Baseline:
    """Scores of one task."""

    task: str
    metric: str
    windows: int
    groups: int
    scores: dict[str, dict[str, tuple[float, float]]]
    """By model, then by way ("by group", "leaky", "on <split>"): mean and standard deviation."""
    mark: str
    """What is wrong with the task; empty if nothing is."""


def baselines(
    directory: Path, tasks: Sequence[str] | None = None, *, workers: int = 1
) -> tuple[list[Baseline], dict[str, str]]:
    """Score simple models on the tasks of the data set in `directory`.

    Features are those of `rubgen features` on the input channels, for WINDOWS windows of each run; every window has the
    answer of its run. By group means by machine where the set has several, else by run, with a twin beside its run.
    Models learn from the split "train" where there is one, and are scored on each other split too.

    - tasks: names in TASKS; all that the set allows when None.
    - workers: number of processes for the features.

    Returns the scores, and the reason for each task that the set does not allow. Raises UserError for an unknown task,
    one that was asked for and is not possible, and without scikit-learn.
    """
    _check_sklearn()
    for name in tasks or ():
        if name not in TASKS:
            raise UserError(f"--task {name!r:.60}: unknown task; {nearest(name, list(TASKS))}")
    data = DataSet(directory)
    possible, reasons = {}, {}
    for name in tasks or TASKS:
        runs = TASKS[name].runs(data)
        reason = _why_not(data, TASKS[name], runs)
        if reason and tasks:
            raise UserError(f"{directory}: --task {name}: {reason}")
        if reason:
            reasons[name] = reason
        else:
            possible[name] = runs
    if not possible:
        raise UserError(f"{directory}: no task is possible: {'; '.join(f'{k}: {v}' for k, v in reasons.items())}")
    run_ids, features = _features(directory, data, workers)
    with threadpool_limits(1):  # threads of OpenMP that wait for each other cost more than they bring
        return [_of_task(data, name, runs, run_ids, features) for name, runs in possible.items()], reasons


def mark_of(scores: dict[str, dict[str, tuple[float, float]]]) -> str:
    """Say whether one threshold solves the task, or no model learns it. Empty for a good task."""
    threshold, best = scores["one threshold"]["by group"][0], max(each["by group"][0] for each in scores.values())
    if threshold > SOLVED:
        return f"one threshold solves it ({threshold:.2f} > {SOLVED})"
    return f"nothing learns it ({best:.2f} < {NOTHING})" if best < NOTHING else ""


def _of_task(data: DataSet, name: str, runs: list[str], run_ids: npt.NDArray[Any], features: Any) -> Baseline:
    task, every = TASKS[name], set(runs)
    rows = np.array([run in every for run in run_ids])
    owner, numbers = np.unique(run_ids[rows], return_inverse=True)
    names = [str(run) for run in owner]
    answers, groups = task.answers(data, names)[numbers], data.groups_of(names)[numbers]
    splits = data.ok.loc[names, "split"].to_numpy(dtype=np.str_)[numbers]
    samples = Samples(features[rows], answers, groups)
    here = splits == TRAIN if TRAIN in splits else np.ones(splits.size, dtype=bool)
    train, scores = samples[here], {}
    made = models(numbers=answers.dtype.kind == "f", classes=np.unique(answers).size)
    for model, make in made.items():
        found = {"by group": cross_validated(train, make, task.score, by_group=True)}
        if model == LEAKY:
            found["leaky"] = cross_validated(train, make, task.score, by_group=False)
        for split in sorted(set(splits[~here])):
            test = samples[splits == split]
            if np.unique(test.answers).size > 1:
                found[f"on {split}"] = transferred(train, test, make, task.score)
        scores[model] = found
    return Baseline(name, task.metric, len(train.groups), np.unique(train.groups).size, scores, mark_of(scores))


def _why_not(data: DataSet, task: Task, runs: list[str]) -> str:
    """Say why the set does not allow the task: too few groups, or a class in too few of them."""
    here = [run for run in runs if data.row(run)["split"] == TRAIN] or runs
    groups = data.groups_of(here) if here else np.array([])
    count = np.unique(groups).size
    of = "runs that rub and have an answer" if task.of_rubs else "runs"
    if count < 2 * FOLDS:
        return f"{of}: {count} groups of them; at least {2 * FOLDS} are needed"
    answers = task.answers(data, here)
    if answers.dtype.kind != "f":
        classes, first = np.unique(answers), {each: np.unique(groups[answers == each]).size for each in answers}
        if classes.size < 2:
            return f"{of} have one class only"
        if min(first.values()) < 2:
            return "a class occurs in one group only"
    return ""


def _features(directory: Path, data: DataSet, workers: int) -> tuple[npt.NDArray[Any], Any]:
    """Return run (windows,) and features (windows, features) of every window."""
    import pandas as pd

    seconds = data.signal_seconds / WINDOWS
    channels = [sensor.name for sensor in data.sensors.sampled if sensor.name in data.inputs]
    with TemporaryDirectory() as folder:
        path = Path(folder) / "features.parquet"
        write_features(directory, path, window=f"{seconds:.9f}s", channels=channels, workers=workers)
        table = pd.read_parquet(path)
    return table["run_id"].to_numpy(dtype=np.str_), table.iloc[:, len(IDS) :].to_numpy(dtype=np.float64)


def _check_sklearn() -> None:
    from importlib.util import find_spec

    if find_spec("sklearn") is None:
        raise UserError("baseline: the package scikit-learn is not installed; pip install 'rubgen[baseline]'")
