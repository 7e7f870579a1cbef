"""Divide the runs of a set for cross-validation, so that what belongs together stays on one side."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rubgen.brief import counted
from rubgen.dataset.reading.samples import chosen_runs
from rubgen.errors import UserError, warn

if TYPE_CHECKING:
    import pandas as pd

    from rubgen.dataset.reading.open import DataSet


class Fold(NamedTuple):
    """The training runs and the test runs of one fold of a cross-validation."""

    train: tuple[str, ...]
    """Names of the runs to learn from, in the order of the set."""
    test: tuple[str, ...]
    """Names of the runs to test with."""


def folds(data: DataSet, k: int, by: str, split: str | None) -> list[Fold]:
    """Divide the good runs of a split, or of the set for None, into `k` folds by the column `by`. See `DataSet.folds`.

    Runs with one value of `by` stay together; by 'run_id' a run stays with its twins. Runs without a value are left
    out, with a warning. Raises UserError for k below 2, for fewer groups than folds, for an unknown split or column,
    and where `by` would put runs of one machine (of several), or a run and its twin, on both sides.
    """
    runs = chosen_runs(data, split, None)
    groups = _groups(data, runs, by)
    sizes = groups.value_counts().sort_index(kind="stable").sort_values(ascending=False, kind="stable")
    if isinstance(k, bool) or not isinstance(k, int) or k < 2:
        raise UserError(f"k = {k!r:.60}: must be a whole number of at least 2")
    if len(sizes) < k:
        found = f"the runs have {counted(len(sizes), 'group')} by {by!r}"
        raise UserError(f"{data.layout.root}: k = {k}: {found}; {_way_out(len(sizes), by)}")
    filled, side = [0] * k, dict.fromkeys(sizes.index, 0)
    for name, size in sizes.items():
        side[name] = filled.index(min(filled))
        filled[side[name]] += int(size)
    known = groups.dropna()  # else NaN, of texts that pandas stores without pyarrow, would differ from every fold
    places = known.map(side)
    without = groups.index[groups.isna()]
    if len(without):
        left = f"{counted(len(without), 'run')} without a value, such as {without[0]}"
        warn(f"{data.layout.root}: by = {by!r}: no fold has {left}")
    return [
        Fold(train=tuple(known.index[places != fold]), test=tuple(known.index[places == fold])) for fold in range(k)
    ]


def base_runs(rows: pd.DataFrame) -> pd.Series[str]:
    """Return the name of the partner of each twin in `rows`, and of each other run its own name."""
    names = rows.index.to_series().astype("string")
    return rows["twin_of"].fillna(names) if "twin_of" in rows else names


def _way_out(groups: int, by: str) -> str:
    """Say what to do where there are fewer groups by the column `by` than folds."""
    if groups > 1:
        return f"take k = {groups}" if groups == 2 else f"take k = {groups} or less"
    if by == "machine_id":
        return "with one machine, by='run_id' tests other runs of the same machine"
    return "folds need two groups at least"


def _groups(data: DataSet, runs: list[str], by: str) -> pd.Series[str]:
    """Return the group of each run. Raises UserError where groups would part what belongs together."""
    rows = data.runs.loc[runs]
    if not isinstance(by, str) or (by != "run_id" and by not in rows):
        raise UserError(f"by = {by!r}: the set has no such column; use 'machine_id'")
    groups = base_runs(rows) if by == "run_id" else rows[by].astype("string")
    machines = rows["machine_id"]
    for together, what in ((machines, "machine"), (base_runs(rows), "run and its twins")):
        parted = groups.groupby(together).nunique(dropna=False)
        several = what != "machine" or machines.nunique() > 1
        if several and (parted > 1).any():
            name = parted.index[parted > 1][0]
            leak = f"runs of the {what} {name} would be on both sides, and the score would be too good"
            raise UserError(f"{data.layout.root}: by = {by!r}: {leak}; use by='machine_id'")
    return groups
