"""The natural share of each class of a balanced set, and the importance weight of each run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rubgen.errors import UserError
from rubgen.scenario.run_id import index_of
from rubgen.scenario.tables.balance import band_name

if TYPE_CHECKING:
    import pandas as pd

    from rubgen.scenario import Recipe
    from rubgen.scenario.tables.balance import Balance


def balance_table(runs: pd.DataFrame, recipe: Recipe) -> pd.DataFrame:
    """Return one row for each class of a balanced set, in each split and each band of the speed.

    - runs: the rows of `runs.parquet`, by name.
    - recipe: the recipe of the set.

    Columns: `split`; `cell`, the class and its band; `wanted`, its share in the recipe over the number of bands;
    `natural`, its estimated share in a set without balance; `runs`, the good runs drawn for the class; `tries`, the
    candidates of these runs and of the failed ones; `weight`, the importance weight of such a run, NaN where there is
    none. Twins do not count. With s_c candidates seen in class c in the split and the band, s their sum, and B bands of
    equal chance, the natural share is

        p(no rub) = s_0 / (s B),   p(c) = (1 / B - p(no rub)) s_c / (sum of s over rubbing classes)

    A candidate that rubs where no rub is wanted may get no class: s counts it, the sum over rubbing classes does not.
    Every candidate is an independent draw, and a run stops at the first candidate in its class, so these ratios tend to
    the shares (Wald's equation). Candidates that are not possible do not count. The weight is p(c) over the share of
    class c among the good runs of the split. A merged set has separate rows for each source, and a first column
    `source` with the digits of `merged_from`. Raises UserError for a set without `[balance]`.
    """
    import pandas as pd

    if len(recipe.sources) == 1:
        return _table(runs, recipe, 0)
    tables, begin = [], 0
    for first, own in recipe.sources:
        mine = runs.iloc[begin : begin + own.runs]
        begin += own.runs
        tables.append(_table(mine, own, first))
        tables[-1].insert(0, "source", str(mine["merged_from"].iloc[0]).partition("/")[0])
    return pd.concat(tables, ignore_index=True)


def _table(runs: pd.DataFrame, recipe: Recipe, first: int) -> pd.DataFrame:
    """Return the rows of one source, whose first run has the number `first`."""
    import pandas as pd

    balance = recipe.balance
    if balance is None:
        raise UserError(f"{recipe.name}: the set has no [balance], so every run has the same weight")
    base = runs[runs["twin_of"].isna()] if "twin_of" in runs else runs
    bands = np.array([balance.place(recipe.seed, index_of(str(name)) - first)[1] for name in base.index])
    rows = []
    for split, group in base.groupby("split", sort=False, observed=True):
        in_split = np.asarray(base["split"] == split)
        for band in range(balance.speed_bands):
            mine = base[in_split & (bands == band)]
            good = group[group["status"] == "ok"]
            rows += _rows(str(split), balance, band, mine, len(good)) if len(mine) else []
    columns = ["split", "cell", "wanted", "natural", "runs", "tries", "weight"]
    return pd.DataFrame(rows, columns=columns)


def _rows(split: str, balance: Balance, band: int, mine: pd.DataFrame, good: int) -> list[list[object]]:
    cells = len(balance.cells)
    counts = [np.asarray(each) for each in mine["balance_seen"] if len(each)]  # empty where a run never was drawn
    seen = np.sum(counts, axis=0) if counts else np.zeros(cells + 2)
    rubbing, classed = seen[1 : cells + 1].sum(), seen[1:cells].sum()
    free = seen[0] / max(seen[0] + rubbing, 1)
    natural = np.array([free, *((1 - free) * seen[1:cells] / max(classed, 1))]) / balance.speed_bands
    rows: list[list[object]] = []
    for cell, share in zip(balance.cells, natural, strict=True):
        name = cell.name + band_name(band, balance.speed_bands)
        drawn = mine[mine["balance_cell"] == name]
        count = int((drawn["status"] == "ok").sum())
        weight = float(share) * good / count if count else np.nan
        wanted = cell.share / balance.speed_bands
        rows.append([split, name, wanted, float(share), count, int(drawn["balance_tries"].sum()), weight])
    return rows


def balance_weights(runs: pd.DataFrame, table: pd.DataFrame) -> pd.Series[float]:
    """Return the importance weight of each run by its name; NaN for a failed run. A twin has the weight of its partner.

    With these weights, a mean over the good runs of a split estimates the mean over a set drawn without balance, except
    for classes that the balance leaves out. `table` is the `balance_table` of the same `runs`. For a merged set it
    estimates the mean over sources drawn without balance.
    """
    import pandas as pd

    merged = "source" in table
    by_cell = {(row.source if merged else "", row.split, row.cell): row.weight for row in table.itertuples()}
    sources = runs["merged_from"].str.partition("/")[0] if merged else [""] * len(runs)
    splits, cells = (runs[name].astype(str) for name in ("split", "balance_cell"))
    keys = zip(sources, splits, cells, runs["status"] == "ok", strict=True)
    values = [by_cell[source, split, cell] if good else np.nan for source, split, cell, good in keys]
    return pd.Series(values, index=runs.index, name="weight", dtype=np.float64)
