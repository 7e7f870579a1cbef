"""The tasks of a data set: what is to be learned, of which windows, and how it is scored."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from rubgen.arrays import BoolArray, FloatArray
from rubgen.baseline.evaluate import Outcome, Samples
from rubgen.baseline.scores import balanced_accuracy, detection_rate, label_f1, macro_f1, rank_correlation
from rubgen.baseline.windows import SetWindows
from rubgen.dataset.reading.answers import Answers
from rubgen.dataset.reading.open import DataSet

SECTORS = 8
"""Equal parts of the casing's circumference; part 0 begins at angle 0."""
MOST_ZONES = 3
"""Runs with more zones of contact count as this number."""
Metric = Callable[[Outcome, Samples], float]
Values = npt.NDArray[Any]


@dataclass(frozen=True)
class Task:
    """One task: the answer of each window, and the metrics of its predictions."""

    answers: Callable[[DataSet, SetWindows], Values]
    """The answer of each window (windows,), or labels of 0 and 1 (windows, labels). -1 or NaN where it has none."""
    metrics: Mapping[str, Metric]
    """By name; the first one decides whether the task is marked."""
    of_rubs: bool = False
    """Whether only runs that rub count."""
    error: bool = False
    """Whether less is better."""


def known(answers: Values) -> BoolArray:
    """Return which windows (windows,) have an answer: a finite number that is not -1.

    All windows have an answer if the answers are labels (windows, labels).
    """
    if answers.ndim == 2:
        return np.ones(len(answers), dtype=bool)
    return np.asarray(np.isfinite(answers) & (answers != -1))


def _rub(data: DataSet, windows: SetWindows) -> Values:
    first = np.sort(np.unique(windows.runs, return_index=True)[1])
    runs, pieces = [str(run) for run in windows.runs[first]], np.split(windows.edges, first[1:])
    return Answers(data, "rub").of_windows(runs, pieces).astype(np.int64)


def _of_runs(target: str) -> Callable[[DataSet, SetWindows], Values]:
    def answers(data: DataSet, windows: SetWindows) -> Values:
        runs, number = np.unique(windows.runs, return_inverse=True)
        return np.asarray(Answers(data, target).of_runs([str(run) for run in runs])[number])

    return answers


def _severity(data: DataSet, windows: SetWindows) -> Values:
    """Return the logarithm of the severity, which has the same ranks."""
    severity = _of_runs("contact_severity")(data, windows).astype(np.float64)
    return np.log10(np.where(severity > 0, severity, np.nan))


def _faults(data: DataSet, windows: SetWindows) -> Values:
    return _of_runs("faults")(data, windows) if data.fault_kinds else np.zeros((len(windows.runs), 1), dtype=np.int64)


def _zones(data: DataSet, windows: SetWindows) -> Values:
    count = data.runs.loc[list(windows.runs), "contact_zones"].to_numpy(dtype=np.int64, na_value=0)
    return np.where(count > 0, np.minimum(count, MOST_ZONES), -1)


def _sectors(data: DataSet, windows: SetWindows) -> Values:
    columns = ["contact_zone_centres_rad", "contact_zone_widths_rad"]
    rows = {run: sectors_of(*each) for run, each in zip(data.ok.index, data.ok[columns].to_numpy(), strict=True)}
    return np.array([rows[run] for run in windows.runs])


def sectors_of(centres: FloatArray | None, widths: FloatArray | None) -> Values:
    """Return which sectors of the casing (SECTORS,) the zones of contact overlap, as 0 and 1.

    `centres` and `widths` (zones,) are in rad; None is no contact.
    """
    if centres is None or widths is None or not len(centres):
        return np.zeros(SECTORS, dtype=np.int64)
    size = 2 * np.pi / SECTORS
    middle = (np.arange(SECTORS) + 0.5) * size
    apart = np.abs((np.asarray(centres)[:, None] - middle + np.pi) % (2 * np.pi) - np.pi)
    return np.asarray((apart < (np.asarray(widths)[:, None] + size) / 2).any(axis=0), dtype=np.int64)


def onset_error(outcome: Outcome, samples: Samples) -> float:
    """Compute the median absolute error of the time at which a rub begins, in s.

    Only runs whose rub begins within their signals at a changing speed count. The predicted time is the middle of the
    first window that is predicted as a rub: its answer in `outcome` is 1. If no window is, it is the end of the last
    window. NaN without a run that counts.
    """
    errors = []
    for run in np.unique(samples.runs[np.isfinite(samples.onset)]):
        here = samples.runs == run
        called = samples.edges[here][outcome.answers[here] == 1].mean(axis=1)
        said = called.min() if called.size else samples.edges[here].max()
        errors.append(abs(said - samples.onset[here][0]))
    return float(np.median(errors)) if errors else np.nan


def onsets(data: DataSet, windows: SetWindows) -> FloatArray:
    """Return when the rub of each window's run begins (windows,), in s from the run's first sample.

    It is NaN if the rub does not begin within the signals. Only runs whose speed changes have an onset. At a steady
    speed it is NaN, also where a growing fault starts the rub.
    """
    changing = data.ok.index[data.ok["onset_speed_rpm"].notna()]
    first = {run: float(touches["start_s"].min()) for run, touches in data.each_touches(list(changing))}
    found = np.array([first.get(run, np.nan) for run in windows.runs])
    return np.where((found > 0) & (found < data.signal_seconds), found, np.nan)


TASKS = {
    "rub": Task(
        _rub,
        {
            "balanced accuracy": lambda outcome, samples: balanced_accuracy(outcome.answers, samples.answers),
            "detected at 1 % false alarms": lambda outcome, samples: detection_rate(outcome.ranks, samples.answers),
        },
    ),
    "severity": Task(
        _severity,
        {"rank correlation": lambda outcome, samples: rank_correlation(outcome.answers, samples.answers)},
        of_rubs=True,
    ),
    "motion": Task(
        _of_runs("motion"),
        {"macro-F1": lambda outcome, samples: macro_f1(outcome.answers, samples.answers)},
        of_rubs=True,
    ),
    "zones": Task(
        _zones, {"macro-F1": lambda outcome, samples: macro_f1(outcome.answers, samples.answers)}, of_rubs=True
    ),
    "where": Task(
        _sectors, {"label F1": lambda outcome, samples: label_f1(outcome.answers, samples.answers)}, of_rubs=True
    ),
    "faults": Task(_faults, {"label F1": lambda outcome, samples: label_f1(outcome.answers, samples.answers)}),
    "onset": Task(_rub, {"median error, s": onset_error}, error=True),
}
"""`rubgen baseline --task`."""
