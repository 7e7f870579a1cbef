"""The rows of a benchmark as its table and out/bench.json have them."""

from __future__ import annotations

from collections.abc import Iterable


def rows_of(rows: Iterable[tuple[str, float, str, str]], prefix: str = "") -> list[dict[str, object]]:
    """Rows of name, value, unit and target, each name with `prefix` before it."""
    return [
        {"name": f"{prefix}{name}", "value": value, "unit": unit, "target": target}
        for name, value, unit, target in rows
    ]
