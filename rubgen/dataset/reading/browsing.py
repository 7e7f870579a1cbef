"""The rows of a data set for Rerun's catalog: what was drawn, the labels, and next to them the answers of a model."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from rubgen.dataset.reading.open import DataSet
from rubgen.errors import UserError, warn
from rubgen.io.columns import Column, Role
from rubgen.io.parquet.words import NUMBERS
from rubgen.labels.headline import headline
from rubgen.machine.problems import nearest

COLUMN_TYPES: dict[str, Any] = {"flag": bool, "integer": int, "number": float, "text": str, "class": str}
"""Kinds of column that have one value a run, and their types."""
ALWAYS = ("run_id", "split", "status")
BELONGING = ("machine_id", "twin_of")
"""Columns of names that tell which runs belong together."""
READERS: dict[str, Callable[[Path], pd.DataFrame]] = {".csv": pd.read_csv, ".parquet": pd.read_parquet}


Values = dict[str, Any]
"""Values of one run by name."""


@dataclass(frozen=True, kw_only=True)
class Rows:
    """The table of a data set in Rerun's catalog: its columns, and the values of each run by name."""

    columns: tuple[tuple[str, str], ...]
    """Group and name of each column, in the order in which they are shown."""
    groups: dict[str, dict[str, Values]]
    """By group and run, the values by name."""


def rows_of(data: DataSet, run_ids: Sequence[str], predictions: Path | None = None) -> Rows:
    """Return the rows of these runs: name, split, status, headline, what differs, labels, and predictions.

    Parameters, the machine and the partner of a twin are shown only where they differ between runs of the set. A failed
    run has no headline. Of the labels those with the role target are shown.

    `predictions` is the path of a file for `read_predictions`, or None. A predicted column with the name of a shown
    column stands after it. A flag `<name>_right` follows, True where both are equal, if the answers are words or
    numbers of a class, 0 or 1 for a flag, whole numbers for an integer, or texts. Other answers, such as probabilities,
    are not compared. Predicted columns with other names stand at the end. Warns of a word that is no class, and where
    no predicted column has the name of a shown one. Raises UserError as `read_predictions` does.
    """
    kinds = {column.name: column for column in data.run_columns if column.kind in COLUMN_TYPES}
    shown = _shown(data.runs, list(kinds.values()))
    runs: dict[str, Values] = {}
    for run_id, row in zip(run_ids, data.runs.loc[list(run_ids)].to_dict("records"), strict=True):
        values = {name: run_id if name == "run_id" else row[name] for name in shown}
        runs[run_id] = {name: COLUMN_TYPES[kinds[name].kind](x) for name, x in values.items() if not pd.isna(x)}
        if row["status"] == "ok":
            runs[run_id]["headline"] = headline(data.row(run_id), data.recipe.operation.profile)
    answers: dict[str, Values] = {}
    guessed: list[str] = []
    if predictions is not None:
        table = read_predictions(predictions, data)
        if not any(name in shown for name in table.columns):
            meant = nearest(str(table.columns[0]), [name for name in shown if kinds[name].role is Role.TARGET])
            warn(f"--predictions {predictions}: no column is called like a label, so none is compared; {meant}")
        for name in map(str, table.columns):
            guessed.append(name)
            values_of, compared = _as_answers(table[name].dropna(), kinds.get(name))
            for run_id in (run_id for run_id in runs if run_id in values_of):
                answer = answers.setdefault(run_id, {})
                answer[name] = values_of[run_id]
                if compared and name in runs[run_id]:
                    answer[f"{name}_right"] = answer[name] == runs[run_id][name]
    found = {name for answer in answers.values() for name in answer}
    order = ["run_id", "headline", *(name for name in shown if name != "run_id")]
    columns = [("run", name) for name in order]
    for name in guessed:
        place = columns.index(("run", name)) + 1 if name in order else len(columns)
        columns[place:place] = [("prediction", each) for each in (name, f"{name}_right") if each in found]
    return Rows(columns=tuple(columns), groups={"run": runs, "prediction": answers})


def read_predictions(path: Path, data: DataSet) -> pd.DataFrame:
    """Read the predictions of a model from a CSV or Parquet file, with one row for each run.

    The column `run_id` is the index of the result. Characters of column names other than letters, digits and _ become
    _. Rows of runs that the set does not have are kept. Raises UserError where the file is missing or of another kind,
    has no `run_id` or no other column, names a run twice, has not one run of the set, contains lists, or where two
    columns get the same name by this change.
    """
    reader, named = READERS.get(path.suffix), f"--predictions {path}"
    if reader is None:
        raise UserError(f"{named}: unknown kind of file; end the name in {' or '.join(READERS)}")
    if not path.is_file():
        raise UserError(f"{named}: there is no such file")
    try:
        found: pd.DataFrame = reader(path)
    except (ValueError, OSError) as error:
        raise UserError(f"{named}: cannot be read as {path.suffix[1:]} ({str(error).splitlines()[0]})") from None
    if found.index.name == "run_id":  # pandas writes the index of a frame to Parquet too
        found = found.reset_index()
    if "run_id" not in found.columns:
        raise UserError(f"{named}: has no column run_id; name the runs there, one row each")
    if len(found.columns) < 2:
        raise UserError(f"{named}: has no column beside run_id; add the answers, such as motion")
    twice = found["run_id"][found["run_id"].duplicated()]
    if not twice.empty:
        raise UserError(f"{named}: {twice.iloc[0]} stands there twice; give one row a run")
    if not found["run_id"].isin(data.runs.index).any():
        raise UserError(
            f"{named}: none of its runs is in {data.layout.root}; they are called {data.runs.index[0]}, ..."
        )
    lists = [name for name in found.columns if not found[name].map(pd.api.types.is_scalar).all()]
    if lists:
        raise UserError(f"{named}: {lists[0]} has lists; give one value a run")
    found.columns = pd.Index([re.sub(r"\W", "_", str(name)) for name in found.columns])  # as Rerun names columns
    alike = found.columns[found.columns.duplicated()]
    if not alike.empty:
        raise UserError(f"{named}: two columns are called {alike[0]} where other characters become _; rename one")
    return found.set_index("run_id")


def _shown(runs: pd.DataFrame, columns: Sequence[Column]) -> list[str]:
    """Return the names of the columns to show: parameters and BELONGING only where they differ between runs."""
    names = [column.name for column in columns if column.name in ALWAYS]
    for column in columns:
        may_differ = column.role is Role.PARAMETER or column.name in BELONGING
        differs = may_differ and column.name in runs and runs[column.name].nunique() > 1
        if differs or (column.role is Role.TARGET and column.name in runs):
            names.append(column.name)
    return names


def _as_answers(given: pd.Series[Any], column: Column | None) -> tuple[dict[str, Any], bool]:
    """Return a model's answers by run as the column of that name has them, and whether they can be right or wrong."""
    plain = {str(run_id): getattr(value, "item", lambda value=value: value)() for run_id, value in given.items()}
    kind = column.kind if column else ""
    numeric = all(isinstance(value, bool | int | float) for value in plain.values())
    if column and kind == "class" and numeric:
        words = {number: word for word, number in NUMBERS[column.name].items()}
        return {run_id: words.get(value, f"class {value:g}") for run_id, value in plain.items()}, True
    if column and kind == "class":
        for word in dict.fromkeys(plain.values()):
            if word not in NUMBERS[column.name]:
                meant = nearest(str(word), list(NUMBERS[column.name]))
                warn(f"--predictions: {column.name} = {word!r:.60}: no such class; {meant}")
    if kind == "flag" and numeric and all(value in (0, 1) for value in plain.values()):
        return {run_id: bool(value) for run_id, value in plain.items()}, True
    if kind == "integer" and numeric and all(float(value).is_integer() for value in plain.values()):
        return {run_id: int(value) for run_id, value in plain.items()}, True
    return plain, kind in ("class", "text") and not numeric
