"""The results of the search, kept as data: `python -m validation.zeng2019 --fit` makes them again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

from validation.piece import Arrays
from validation.rows import read_rows, write_rows
from validation.zeng2019.fitting.candidate import Candidate
from validation.zeng2019.fitting.score import Score, score

EVIDENCE = Path(__file__).parent / "found.json"
"""Rows of the candidates' values with `blisk` and `casing`, their motion at each of TARGETS."""
Seen = dict[Candidate, Arrays]


def write_evidence(path: Path, seen: Seen) -> None:
    """Write the motion of each candidate at each target."""
    write_rows(path, [{**asdict(one), **{part: list(map(str, of[part])) for part in of}} for one, of in seen.items()])


def read_evidence(path: Path = EVIDENCE) -> list[Score]:
    """The scores of all candidates of the search."""
    rows = read_rows(path)
    values = [{name: row[name] for name in Candidate.__dataclass_fields__} for row in rows]
    arrays = [{part: np.array(row[part]) for part in ("blisk", "casing")} for row in rows]
    return [score(Candidate(**value), seen) for value, seen in zip(values, arrays, strict=True)]


def scores_of(seen: Seen) -> Sequence[Score]:
    """The scores of candidates that were run."""
    return [score(one, of) for one, of in seen.items()]
