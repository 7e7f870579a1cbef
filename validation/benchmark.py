"""What a set of the benchmark holds and what baselines score on it: `python -m validation.benchmark DIR`.

Both tables go to docs/benchmark.md.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import rubgen
from rubgen.baseline.baseline import Baseline, baselines
from rubgen.baseline.table import table as table_of_scores
from rubgen.dataset.files import write_text
from rubgen.dataset.making.workers import usable_cores
from rubgen.dataset.reading.open import DataSet
from rubgen.scenario import load_recipe
from validation.markdown import table, with_tables

PAGE = Path(__file__).parents[1] / "docs" / "benchmark.md"
RECIPE = "blade-rub-bench-v1"


def counts(data: DataSet) -> str:
    """A table of the splits: machines, runs, runs that ended well, and those of them that rub."""
    rows = [
        [
            str(split),
            *map(str, (part["machine_id"].nunique(), len(part), (part["status"] == "ok").sum(), part["rub"].sum())),
        ]
        for split, part in data.runs.groupby("split", observed=True)
    ]
    return table(["split", "machines", "runs", "ended well", "rub"], rows, numbers_from=1)


def results(data: DataSet, found: Sequence[Baseline], whole: int) -> str:
    """The part of the page: how large the set is, what it holds, and the scores."""
    return f"""Of {len(data.runs):,} runs of {whole:,}, made with rubgen {rubgen.__version__}:

{counts(data)}

{table_of_scores(found)}"""


def main() -> None:
    """Score the set and write the page."""
    parser = argparse.ArgumentParser(prog="python -m validation.benchmark")
    parser.add_argument("directory", type=Path)
    directory = parser.parse_args().directory
    found, reasons = baselines(directory, workers=usable_cores())
    text = results(rubgen.open(directory), found, load_recipe(RECIPE).runs)
    impossible = "".join(f"\n- {name}: not possible: {reason}" for name, reason in reasons.items())
    page = with_tables(PAGE.read_text(encoding="utf-8"), {"baselines": text + impossible})
    write_text(PAGE, page)


if __name__ == "__main__":
    main()
