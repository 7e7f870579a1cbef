"""The baselines of a data set, with what they say of its tasks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from threadpoolctl import threadpool_limits

from rubgen.arrays import IntArray
from rubgen.baseline.evaluate import FOLDS, SEEDS, Samples, Scores, cross_validated, transferred
from rubgen.baseline.models import models
from rubgen.baseline.tasks import TASKS, Task, known, onsets
from rubgen.baseline.windows import TRAIN, SetWindows, windows_of
from rubgen.brief import counted
from rubgen.dataset.making.workers import unordered, worker_pool
from rubgen.dataset.reading.open import DataSet
from rubgen.errors import UserError
from rubgen.machine.problems import nearest
from rubgen.progress import count, step

SOLVED, NOTHING = 0.95, 0.6
"""A task that one threshold scores higher on is too easy; one that no model scores so much on teaches nothing."""
LEAST_GAIN = 0.1
"""Share of what the majority lacks, which a model must take away."""
LEAKY = ("boosting", "rocket")
"""The models whose leaky score is made too."""
BY_GROUP = "by group"
ModelScores = dict[str, dict[str, Scores]]
"""By model, then by way ("by group", "leaky", "on <split>")."""


@dataclass(frozen=True)
class Baseline:
    """Scores of the simple models on one task."""

    task: str
    windows: int
    """Windows that models learn from, and are scored on by group."""
    groups: int
    scores: ModelScores
    mark: str
    """What is wrong with the task; empty if nothing is."""


class TaskWindows(NamedTuple):
    """The windows that count for a task."""

    samples: Samples
    """The windows without their inputs."""
    splits: npt.NDArray[np.str_]
    """The split of each."""
    rows: IntArray
    """The number of each among all windows of the set."""


def baselines(
    directory: Path, tasks: Sequence[str] | None = None, *, workers: int = 1
) -> tuple[list[Baseline], dict[str, str]]:
    """Score simple models on the tasks of the data set in `directory`.

    - tasks: names in TASKS; None takes all that are possible with the set.
    - workers: number of processes. Scores do not depend on it.

    Models see the input channels of WINDOWS windows of each run: as the features of `rubgen features`, or as random
    convolutions. The score "by group" keeps a machine on one side of a split where the set has several machines, else a
    run with its twin, the same run with one thing changed. Models learn from the split "train", if the set has one, and
    are also scored on each other split. The models in LEAKY also have a score "leaky", with windows of one run on both
    sides. Returns the scores, and the reason for each task that is not possible with the set. Raises UserError for an
    unknown task, a task in `tasks` that is not possible, a set that allows no task, a set without good runs, and where
    scikit-learn is not installed.
    """
    _check_sklearn()
    for name in tasks or ():
        if name not in TASKS:
            raise UserError(f"--task {name!r:.60}: unknown task; {nearest(name, list(TASKS))}")
    data = DataSet(directory)
    if not len(data.ok):
        raise UserError(f"{directory}: no run of this set ended well; there is nothing to score")
    blank = _blank_windows(data)
    reasons = {name: _why_not(data, TASKS[name], blank) for name in tasks or TASKS}
    reasons = {name: reason for name, reason in reasons.items() if reason}
    if reasons and tasks:
        name, reason = next(iter(reasons.items()))
        raise UserError(f"{directory}: --task {name}: {reason}")
    if len(reasons) == len(tasks or TASKS):
        alike = [([name for name in reasons if reasons[name] == why], why) for why in dict.fromkeys(reasons.values())]
        every = "; ".join(f"{', '.join(names)}: {why}" for names, why in alike)
        raise UserError(f"{directory}: no task is possible: {every}")
    windows = windows_of(directory, data, SEEDS, workers)
    return _scored(data, windows, [name for name in tasks or TASKS if name not in reasons], workers), reasons


def mark_of(scores: ModelScores, task: Task) -> str:
    """Return a clause that says that one threshold solves the task, or that nothing learns it. Empty for a good task.

    `scores` are the scores of all models on `task`. The first metric of the task is used, with the score by group. If
    it is undefined there, it is the score on the first split where it is defined, such as the onset where training has
    steady speeds. The clause is empty if it is defined nowhere.

    - One threshold solves the task if its score is above SOLVED.
    - Nothing learns the task if the best score is below NOTHING.
    - Nothing learns it either if no model removes more than LEAST_GAIN of what the majority lacks: of its error, or of
      1 less its score. For a metric that is an error only this is asked.
    """
    metric = next(iter(task.metrics))
    way = next((way for way, each in scores["majority"].items() if metric in each), None)
    if way is None:
        return ""
    by_model = {model: ways[way][metric][0] for model, ways in scores.items() if metric in ways.get(way, {})}
    majority = by_model["majority"]
    if task.error:
        least = min(by_model.values())
        learned = least < majority * (1 - LEAST_GAIN)
        return "" if learned else f"nothing learns it ({least:.2g} s, the majority {majority:.2g} s)"
    threshold, best = by_model["one threshold"], max(by_model.values())
    if threshold > SOLVED:
        return f"one threshold solves it ({threshold:.2f} > {SOLVED})"
    if best < NOTHING:
        return f"nothing learns it ({best:.2f} < {NOTHING})"
    learned = best - majority > LEAST_GAIN * (1 - majority)
    return "" if learned else f"nothing learns it ({best:.2f}, the majority {majority:.2f})"


def _scored(data: DataSet, windows: SetWindows, names: Sequence[str], workers: int) -> list[Baseline]:
    """Score all models on the tasks called `names`. Each model of each task is one job of the `workers` processes.

    Jobs with the most answers begin first, so that no long one is left at the end.
    """
    parts = {name: _windows_of_task(data, TASKS[name], windows) for name in names}
    found: dict[str, ModelScores] = {
        name: {model: {} for model in models(part.samples.answers)} for name, part in parts.items()
    }
    with TemporaryDirectory() as folder, step("learn", "models"):
        files = {name: Path(folder) / f"{name}.npy" for name in windows.inputs}
        for name, path in files.items():
            np.save(path, windows.inputs[name])
        longest = sorted(names, key=lambda name: -parts[name].samples.answers.size)
        jobs = [(name, model, parts[name], files) for name in longest for model in reversed(found[name])]
        with worker_pool(min(workers, len(jobs))) as pool:
            for done, (name, model, scores) in enumerate(unordered(pool, _scores_of, jobs), 1):
                found[name][model] = scores
                count(done, len(jobs))
    return [_baseline(name, parts[name], found[name]) for name in names]


def _baseline(name: str, part: TaskWindows, scores: ModelScores) -> Baseline:
    groups = part.samples.groups[_learned(part.splits)]
    return Baseline(name, groups.size, np.unique(groups).size, scores, mark_of(scores, TASKS[name]))


def _scores_of(
    task_name: str, name: str, part: TaskWindows, files: Mapping[str, Path]
) -> tuple[str, str, dict[str, Scores]]:
    """Return the two names, and the scores of the model by way. `files` hold the inputs. A worker process calls it."""
    task, model = TASKS[task_name], models(part.samples.answers)[name]
    names = {model.inputs(seed) for seed in range(SEEDS)}
    inputs = {each: np.load(files[each], mmap_mode="r", allow_pickle=False)[part.rows] for each in names}
    samples, here = replace(part.samples, inputs=inputs), _learned(part.splits)
    train = samples[here]
    tests = {f"on {split}": samples[part.splits == split] for split in dict.fromkeys(part.splits[~here])}
    tests = {way: test for way, test in tests.items() if test.answers.ndim == 2 or np.unique(test.answers).size > 1}
    found = {}
    with threadpool_limits(1):  # threads of OpenMP that wait for each other cost more than they bring
        found[BY_GROUP] = cross_validated(train, model, task.metrics, by_group=True)
        if name in LEAKY:
            found["leaky"] = cross_validated(train, model, task.metrics, by_group=False)
        found |= transferred(train, tests, model, task.metrics)
    return task_name, name, {way: scores for way, scores in found.items() if scores}


def _windows_of_task(data: DataSet, task: Task, windows: SetWindows) -> TaskWindows:
    """Return the windows that count for a task."""
    answers = task.answers(data, windows)
    rows = known(answers)
    if task.of_rubs:
        rows &= data.ok.loc[list(windows.runs), "rub"].to_numpy(dtype=bool)
    every = Samples({}, answers, windows.groups, windows.runs, windows.edges, onsets(data, windows))
    return TaskWindows(every[rows], windows.splits[rows], np.flatnonzero(rows))


def _learned(splits: npt.NDArray[np.str_]) -> npt.NDArray[np.bool_]:
    return splits == TRAIN if TRAIN in splits else np.ones(splits.size, dtype=bool)


def _blank_windows(data: DataSet) -> SetWindows:
    """Return one window a run, of the whole signals and without inputs, to see what the set allows."""
    runs = data.ok.index.to_numpy(dtype=np.str_)
    edges = np.tile([0.0, data.signal_seconds], (runs.size, 1))
    return SetWindows(runs, edges, data.ok["split"].to_numpy(dtype=np.str_), data.groups_of(list(runs)), {})


def _why_not(data: DataSet, task: Task, blank: SetWindows) -> str:
    """Say why the set does not allow the task: too few groups, or a class in too few of them."""
    samples, splits, _ = _windows_of_task(data, task, blank)
    if task.error and not np.isfinite(samples.onset).any():
        return "no run begins to rub within its signals while its speed changes"
    train = samples[_learned(splits)]
    count = np.unique(train.groups).size
    of = "runs that rub and have an answer" if task.of_rubs else "runs"
    if count < 2 * FOLDS:
        machines = data.ok["machine_id"].nunique() > 1
        found = f"{counted(count, 'machine')} to learn from" if machines else f"{count} of them to learn from"
        return f"{of}: {found}; at least {2 * FOLDS} are needed, so make a larger set"
    if train.answers.dtype.kind == "f":
        return ""
    for labels in np.atleast_2d(train.answers.T):
        classes = np.unique(labels)
        if classes.size > 1 and min(np.unique(train.groups[labels == each]).size for each in classes) > 1:
            return ""
    return f"{of} have one class only" if np.unique(train.answers).size < 2 else "a class occurs in one group only"


def _check_sklearn() -> None:
    from importlib.util import find_spec

    if find_spec("sklearn") is None:
        raise UserError("baseline: the package scikit-learn is not installed; pip install 'rubgen[baseline]'")
