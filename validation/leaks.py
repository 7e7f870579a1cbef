"""`python -m validation.leaks DIR`: whether anything in `signals/` but the signals tells of a rub.

A tree learns `rub` from names, places in the files, counts of samples and of nulls, pulses, and the compressed sizes of
all columns but the channels and the answers: their sizes follow from what they hold. A second tree learns from the
number of samples that are exactly 0, counted against the samples near 0, since a loud signal has fewer of both. The
better balanced accuracy by group of the two is compared with the one after the answers were dealt anew among runs of
one split and of nearly one speed. So what the speed tells is no leak, and the error of the score is that of this set.
Exit code 1 where a leak was found.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from scipy.stats import binom
from sklearn.tree import DecisionTreeClassifier

from rubgen.baseline.evaluate import folds
from rubgen.baseline.scores import balanced_accuracy
from rubgen.dataset.reading.open import DataSet
from rubgen.errors import UserError
from rubgen.io.columns import Role
from validation.command import run_command

DEALT = 99
"""How often answers are dealt anew. A leak is a score that none of them reaches: by chance that happens once in 100."""
SPEED_BANDS = 4
NEAR = 2
"""Steps of a channel's resolution about 0 that are near 0."""
PERIODS = (2, 3, 4, 8)
"""Periods of the places in the files that are looked at: a twin may always be the second of two runs."""
ANSWER, GROUP, SPLIT, PULSES = "rub", "machine_id", "split", "once_per_rev_s"
ZEROS = "_zeros"


@dataclass(frozen=True)
class Verdict:
    """What the facts beside the signals tell of a rub."""

    score: float
    """Balanced accuracy by group."""
    chance: float
    """Mean of it over answers dealt anew."""
    error: float
    """Standard deviation of it over answers dealt anew."""
    found: bool
    """Whether the score is above all of them."""
    best: str
    """The fact that the better tree uses most."""


def facts_of(files: Sequence[Path]) -> pd.DataFrame:
    """Return all facts of the runs in these files of `signals/`, one row a run, with rub, machine, split and speed.

    Columns that are no facts begin with an underscore.
    """
    rows: list[dict[str, Any]] = []
    rng = np.random.default_rng(0)
    for number, path in enumerate(files):
        with pq.ParquetFile(path) as file:
            for group in range(file.num_row_groups):
                size = _size_beside_signals(file, group)
                for place, row in enumerate(_rows(file, group, rng)):
                    where = {"file": number, "row_group": group, "place_in_group": place, "place": len(rows)}
                    where |= {"bytes_beside_signals": size}
                    rows.append(where | {f"place_of_{each}": len(rows) % each for each in PERIODS} | row)
    table = pd.DataFrame(rows)
    for name in table.select_dtypes(exclude="number").columns:
        if not name.startswith("_"):
            table[name] = np.unique(table[name].fillna("").astype(str), return_inverse=True)[1]
    return table


def verdict(facts: pd.DataFrame, seed: int = 0) -> Verdict:
    """Compare the score of the better tree with its scores on answers dealt anew. UserError for one class."""
    answers = facts["_rub"].to_numpy(dtype=np.int64)
    if min(np.sum(answers == each) for each in (0, 1)) < 10:
        raise UserError(f"{answers.sum()} of {answers.size} runs rub; both classes need at least 10")
    known = facts.loc[:, [not name.startswith("_") for name in facts.columns]]
    zeros = known.columns.str.endswith(ZEROS)
    parts = [part for part in (known.loc[:, ~zeros], known.loc[:, zeros]) if part.shape[1]]
    groups = facts["_group"].to_numpy(dtype=np.str_)
    bands = facts.groupby("_split")["_speed"].transform(
        lambda each: pd.qcut(each, SPEED_BANDS, labels=False, duplicates="drop")
    )
    strata = facts["_split"].astype(str) + bands.fillna(-1).astype(str)
    rng = np.random.default_rng(seed)
    scores = [_score(part, answers, groups) for part in parts]
    anew = [_dealt(answers, strata.to_numpy(), rng) for _ in range(DEALT)]
    dealt = [max(_score(part, each, groups) for part in parts) for each in anew]
    better = parts[int(np.argmax(scores))]
    best = str(better.columns[int(np.argmax(_tree().fit(better.to_numpy(), answers).feature_importances_))])
    return Verdict(max(scores), float(np.mean(dealt)), float(np.std(dealt)), max(scores) > max(dealt), best)


def _size_beside_signals(file: pq.ParquetFile, group: int) -> int:
    """Return the compressed bytes of a row group without its channels and answers."""
    told = {
        field.name for field in file.schema_arrow if Role(field.metadata[b"role"].decode()) in (Role.INPUT, Role.TARGET)
    }
    columns = (file.metadata.row_group(group).column(each) for each in range(file.metadata.num_columns))
    return sum(each.total_compressed_size for each in columns if each.path_in_schema.split(".")[0] not in told)


def _rows(file: pq.ParquetFile, group: int, rng: np.random.Generator) -> Iterator[dict[str, Any]]:
    """Yield the facts of the rows of a row group."""
    table = file.read_row_group(group)
    for row in range(table.num_rows):
        found: dict[str, Any] = {}
        for field in table.schema:
            value = table[field.name][row]
            if field.name == ANSWER:
                found["_rub"] = value.as_py()
            elif Role(field.metadata[b"role"].decode()) is not Role.TARGET:
                found |= _of_value(field, value, rng)
        found["_group"] = found.pop(f"_{GROUP}") or str(row)
        yield found


def _of_value(field: pa.Field, value: pa.Scalar, rng: np.random.Generator) -> dict[str, Any]:
    """Return the facts of one value: of a list its length, nulls, zeros, and first and last of pulses."""
    name = field.name
    if pa.types.is_list(field.type) or pa.types.is_fixed_size_list(field.type):
        values = value.values
        if values is None:
            return {f"{name}_null": 1}
        numbers = values.to_numpy(zero_copy_only=False)
        found: dict[str, Any] = {
            f"{name}_null": 0,
            f"{name}_length": numbers.size,
            f"{name}_undefined": int(np.sum(~np.isfinite(numbers))),
            f"{name}{ZEROS}": zeros_among_near(numbers, rng),
        }
        if name == PULSES:
            apart = np.diff(numbers) if numbers.size > 1 else np.zeros(1)
            found |= {"first_pulse": numbers[0] if numbers.size else 0, "_speed": 1 / max(apart.mean(), 1e-9)}
            found |= {"speed": found["_speed"], "spread_of_turns": apart.std()}
        return found
    plain = value.as_py()
    kept = {f"_{name}": plain} if name in (GROUP, SPLIT) else {}
    if isinstance(plain, str):
        digits = re.findall(r"\d+", plain)
        number = int(digits[-1][-9:]) if digits else -1
        return {name: plain, f"{name}_number": number, f"{name}_length": len(plain), **kept}
    return {name: np.nan if plain is None else float(plain), f"{name}_null": int(plain is None), **kept}


def zeros_among_near(values: npt.NDArray[Any], rng: np.random.Generator) -> float:
    """Return how many of `values` (any,) are exactly 0, as a place from 0 (fewer than by chance) to 1 (more).

    If 0 is as likely as each of the 2 NEAR values about it, the number of zeros among the n values near 0 is binomial,
    with n trials of probability 1 / (2 NEAR + 1). Its place is the distribution function, uniform within a step.
    So it is uniform whatever n is, and n follows the amplitude. Values are spaced by the least difference of two. Their
    spread must be some 20 such steps; below that 0 is more likely than its neighbours.
    """
    steps = np.diff(np.unique(values[np.isfinite(values)]))
    within = (NEAR + 0.5) * steps.min() if steps.size else 0.0
    zeros, near = np.sum(values == 0), np.sum(np.abs(values) <= within)
    chance = binom(near, 1 / (2 * NEAR + 1))
    return float(chance.cdf(zeros) - rng.random() * chance.pmf(zeros))


def _score(facts: pd.DataFrame, answers: npt.NDArray[Any], groups: npt.NDArray[Any]) -> float:
    values, said = facts.to_numpy(dtype=np.float64), np.empty_like(answers)
    for test in folds(groups, answers, seed=0):
        said[test] = _tree().fit(values[~test], answers[~test]).predict(values[test])
    return balanced_accuracy(said, answers)


def _tree() -> DecisionTreeClassifier:
    return DecisionTreeClassifier(max_depth=4, min_samples_leaf=3, class_weight="balanced", random_state=0)


def _dealt(answers: npt.NDArray[Any], strata: npt.NDArray[Any], rng: np.random.Generator) -> npt.NDArray[Any]:
    made = answers.copy()
    for each in np.unique(strata):
        here = np.flatnonzero(strata == each)
        made[here] = answers[rng.permutation(here)]
    return made


def main(arguments: Sequence[str]) -> int:
    """Print the verdict on the set in the directory that is given."""
    if len(arguments) != 1:
        sys.stderr.write("usage: python -m validation.leaks DIR\n")
        return 2
    data, found = DataSet(Path(arguments[0])), []

    def work() -> None:
        files = [data.layout.root / name for name in data.manifest.listed("signals")]
        found.append(verdict(facts_of(files)))

    code = run_command("validation.leaks", data.layout.root, work)
    for each in found:
        beside = f"balanced accuracy {each.score:.3f}, chance {each.chance:.3f} ± {each.error:.3f}"
        sys.stdout.write(f"{beside}: {f'a leak, most by {each.best}' if each.found else 'no leak'}\n")
    return code or int(any(each.found for each in found))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
