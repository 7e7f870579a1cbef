"""Rows of a table in a JSON file."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rubgen.dataset.files import write_json

Row = dict[str, Any]


def write_rows(path: Path, rows: Sequence[Row]) -> None:
    """Write the rows as a JSON list; NaN, which JSON has not, becomes null."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_json(path, _without_nan(list(rows)))


def read_rows(path: Path) -> list[Row]:
    """The rows of a file; none where it is not there or is no JSON."""
    try:
        rows: list[Row] = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return []
    return rows


def replace_rows(path: Path, rows: Sequence[Row], by: str) -> None:
    """Write the rows in place of those of the file that have the same value of `by`; all others stay."""
    groups: dict[object, list[Row]] = {}
    for row in read_rows(path):
        groups.setdefault(row.get(by), []).append(row)
    groups |= {name: [row for row in rows if row[by] == name] for name in {row[by]: None for row in rows}}
    write_rows(path, [row for group in groups.values() for row in group])


def _without_nan(value: object) -> object:
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, dict):
        return {key: _without_nan(inner) for key, inner in value.items()}
    return [_without_nan(inner) for inner in value] if isinstance(value, list) else value
