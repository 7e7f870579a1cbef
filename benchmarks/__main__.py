"""Run every benchmark, print one table, write out/bench.json. `python -m benchmarks [NAME ...]` runs some alone.

A row without a value has a note that says why. What runs alone takes the place of its rows in out/bench.json.
"""

from __future__ import annotations

import importlib
import sys
import time
from pathlib import Path

from validation.rows import replace_rows

NAMES = tuple(sorted(path.stem.removeprefix("bench_") for path in Path(__file__).parent.glob("bench_*.py")))


def main(names: tuple[str, ...]) -> None:
    out = Path("out/bench.json")
    for name in names:
        start = time.perf_counter()
        rows = [{"benchmark": name, **row} for row in importlib.import_module(f"benchmarks.bench_{name}").measure()]
        replace_rows(out, rows, by="benchmark")
        for row in rows:
            print(text(row), flush=True)
        print(f"    ({name}: {time.perf_counter() - start:.0f} s)", flush=True)


def text(row: dict) -> str:
    """One line of the table."""
    if row["value"] is None:
        return f"{row['name']:<62}{'-':>12} {row['unit']:<8}{row['target']}: {row['note']}"
    return f"{row['name']:<62}{row['value']:>12.4g} {row['unit']:<8}{row['target']}"


if __name__ == "__main__":
    main(tuple(sys.argv[1:]) or NAMES)
