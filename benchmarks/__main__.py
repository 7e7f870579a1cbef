"""Run every benchmark, print one table, write out/bench.json. `python -m benchmarks [NAME ...]` runs some alone."""

from __future__ import annotations

import importlib
import json
import sys
from pathlib import Path

NAMES = ("solver", "reduction", "start", "memory")


def main(names: tuple[str, ...]) -> None:
    rows = []
    for name in names:
        for row in importlib.import_module(f"benchmarks.bench_{name}").measure():
            rows.append(row)
            print(f"{row['name']:<58}{row['value']:>12.4g} {row['unit']:<10}{row['target']}", flush=True)
    out = Path("out")
    out.mkdir(exist_ok=True)
    (out / "bench.json").write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(tuple(sys.argv[1:]) or NAMES)
