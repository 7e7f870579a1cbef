"""Answers of runs and of windows: one target as numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray
from rubgen.dataset.reading.tables import FIRST_SAMPLE
from rubgen.errors import UserError, warn
from rubgen.io.columns import Role
from rubgen.io.parquet.words import NUMBERS
from rubgen.machine.problems import nearest
from rubgen.solver.response import WINDOW_TURNS

if TYPE_CHECKING:
    import pandas as pd

    from rubgen.dataset.reading.open import DataSet

Row = dict[str, Any]
KINDS = ("flag", "class", "integer", "number")
"""Kinds of columns with one value a run."""
SHOWN = 12
"""Number of targets that a message lists."""


class Answers:
    """The values of one column of `runs` as numbers, for runs or windows. `DataSet.arrays` describes the numbers."""

    def __init__(self, data: DataSet, target: str) -> None:
        """Take the name of a column of any role but id, such as a label or a parameter.

        Raises UserError for any other name, and for a column without one flag, class or number a run, except `faults`.
        """
        columns = {column.name: column for column in data.run_columns}
        targets = [name for name, column in columns.items() if column.role is Role.TARGET]
        if not isinstance(target, str) or target not in columns or columns[target].role is Role.ID:
            raise UserError(f"{data.layout.root}: no target {target!r}; {nearest(str(target), targets)}")
        self._data, self._column = data, columns[target]
        if target != "faults" and self._column.kind not in KINDS:
            kind = "a text" if self._column.kind == "text" else "a list of another length in each run"
            raise UserError(f"{data.layout.root}: target {target!r} is {kind}; read it from data.runs[{target!r}]")

    def of_runs(self, runs: Sequence[str]) -> npt.NDArray[Any]:
        """Return the answer of each of the runs, by name: (runs,), or for the target `faults` (runs, kinds).

        A kind of fault is 1 where the run has it, else 0, in the order of `DataSet.fault_kinds`. A flag is 0 or 1, a
        class its number or -1 where it is undefined, a number NaN where it is undefined. If a flag or an integer is
        undefined in any of the runs, all are floats, with NaN there. Raises KeyError for an unknown run.
        """
        values = self._data.runs.loc[list(runs), self._column.name]
        if self._column.name == "faults":
            kinds = self._data.fault_kinds
            return np.array([[kind in found for kind in kinds] for found in values], dtype=np.int64)
        if self._column.kind == "class":
            return np.array([NUMBERS[self._column.name].get(word, -1) for word in values.fillna("")], dtype=np.int64)
        if self._column.kind == "number" or values.isna().any():
            return values.to_numpy(dtype=np.float64, na_value=np.nan)
        return values.to_numpy(dtype=np.int64)

    def of_windows(self, runs: Sequence[str], pieces: Sequence[FloatArray]) -> npt.NDArray[Any]:
        """Return the answer of each window (windows,), run after run, or for the target `faults` (windows, kinds).

        The targets rub, contact_duty and contact_impulse_per_turn_n_s are computed of the window's own stretch of time,
        from the touches. For motion it is the class in this stretch, or -1 where windows of the labels that it overlaps
        differ. For any other target every window has the value of the run. `pieces` are start and end of the windows of
        each run (windows, 2), in s from the first sample.
        """
        compute = _OF_STRETCH.get(self._column.name)
        if compute is None:
            return np.repeat(self.of_runs(runs), [len(edges) for edges in pieces], axis=0)
        rows = zip(self._data.each_touches(runs), pieces, strict=True)
        return np.concatenate([compute(self._data.row(run_id), touches, edges) for (run_id, touches), edges in rows])

    def warn_of_missing(self, y: npt.NDArray[Any], split: str | None) -> None:
        """Warn if all answers `y`, at least one, are the same class or flag: no model can learn from them.

        `split` is the name of their split for the message, or None.
        """
        if self._column.kind not in ("flag", "class") or np.unique(y).size > 1:
            return
        where = f"of split {split!r}" if split else "chosen"
        words = NUMBERS.get(self._column.name, {"False": 0, "True": 1})
        only = {number: word for word, number in words.items()}
        value = "undefined" if np.isnan(y[0]) else only.get(int(y[0]), "undefined")
        same = f"all runs {where} have {self._column.name} = {value}"
        warn(f"{self._data.layout.root}: {same}: nothing can be learned from them or tested; take others")


def _rub(row: Row, touches: pd.DataFrame, edges: FloatArray) -> npt.NDArray[Any]:
    return (_duty(row, touches, edges) > 0).astype(np.int64)


def _duty(_row: Row, touches: pd.DataFrame, edges: FloatArray) -> FloatArray:
    """Return the share of each window in which any blade touches (windows,)."""
    if touches.empty:
        return np.zeros(len(edges))
    start, end = touches["start_s"].to_numpy(), touches["end_s"].to_numpy()
    latest = np.maximum.accumulate(end)
    start = np.maximum(start, np.concatenate([[start[0]], latest[:-1]]))  # disjoint pieces of the union of all touches
    knots = np.column_stack([start, np.maximum(start, end)])
    lengths = np.cumsum(np.diff(knots, axis=1))
    covered = np.interp(edges, knots.ravel(), np.column_stack([np.append(0.0, lengths[:-1]), lengths]).ravel())
    return np.asarray(np.diff(covered, axis=1)[:, 0] / np.diff(edges, axis=1)[:, 0])


def _impulse(row: Row, touches: pd.DataFrame, edges: FloatArray) -> FloatArray:
    """Return the mean normal impulse a turn of each window in N s.

    The impulse of a touch is spread evenly over its duration.
    """
    start, end = touches["start_s"].to_numpy(), touches["end_s"].to_numpy()
    density = touches["impulse_n_s"].to_numpy() / (end - start)
    inside = [np.clip(np.minimum(end, b) - np.maximum(start, a), 0, None) @ density for a, b in edges]
    times = np.asarray(row["window_starts_s"]) - touches.attrs[FIRST_SAMPLE]
    turns = np.interp(edges, times, WINDOW_TURNS * np.arange(times.size))
    turns += np.maximum(edges - times[-1], 0) * row["window_speeds_rpm"][-1] / 60
    return np.asarray(inside / np.diff(turns, axis=1)[:, 0])


def _motion(row: Row, touches: pd.DataFrame, edges: FloatArray) -> npt.NDArray[Any]:
    """Return the class of motion of each window; -1 where the labelled windows that it touches differ."""
    times, classes = np.asarray(row["window_starts_s"]), np.asarray(row["window_motion_classes"])
    edges = edges + touches.attrs[FIRST_SAMPLE]
    begin = np.maximum(np.searchsorted(times, edges[:, 0], side="right") - 1, 0)
    end = np.searchsorted(times, edges[:, 1], side="left")
    same = [np.unique(classes[a:b]).size == 1 for a, b in zip(begin, end, strict=True)]
    return np.where(same, classes[begin], -1)


_OF_STRETCH: dict[str, Callable[[Row, pd.DataFrame, FloatArray], npt.NDArray[Any]]] = {
    "rub": _rub,
    "contact_duty": _duty,
    "contact_impulse_per_turn_n_s": _impulse,
    "motion": _motion,
}
"""Targets that a window has of its own: the answer of its stretch, from the touches and the changes of motion."""
