"""What a set of the benchmark holds and what baselines score on it: `python -m validation.benchmark DIR [--ways N]`.

The tables go to docs/benchmark.md. With --ways only the last one is made. It is of the first N runs, made in three ways
beside DIR: as they are, without the noise of sensors, and without surroundings.
"""

from __future__ import annotations

import argparse
import tomllib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import rubgen
from rubgen.baseline.baseline import BY_GROUP, Baseline, baselines
from rubgen.baseline.table import table as table_of_scores
from rubgen.baseline.tasks import TASKS
from rubgen.dataset.files import write_text
from rubgen.dataset.making.workers import usable_cores
from rubgen.dataset.reading.open import DataSet
from rubgen.scenario import load_recipe
from rubgen.scenario.load import RECIPES
from validation.markdown import table, with_tables

PAGE = Path(__file__).parents[1] / "docs" / "benchmark.md"
RECIPE = "blade-rub-bench-v1"
MODELS = ("majority", "one threshold", "boosting", "rocket")
WAY_TASKS = ("rub", "severity", "faults")


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
    many = f"all {whole:,} runs" if len(data.runs) == whole else f"{len(data.runs):,} runs of {whole:,}"
    return f"""Of {many}, made with rubgen {rubgen.__version__}:

{counts(data)}

{table_of_scores(found)}"""


def as_it_is(_recipe: dict[str, Any]) -> None:
    """Change nothing."""


def without_noise(recipe: dict[str, Any]) -> None:
    """Take the noise of all sensors away."""
    recipe["sensors"]["noise"] = 0


def without_surroundings(recipe: dict[str, Any]) -> None:
    """Take the surroundings of all splits away. The faults of the machine remain."""
    for part in (recipe, *(each for each in recipe["splits"].values() if isinstance(each, dict))):
        part.pop("surroundings", None)


WAYS: dict[str, Callable[[dict[str, Any]], None]] = {
    "as it is": as_it_is,
    "without noise of the sensors": without_noise,
    "without surroundings": without_surroundings,
}


def made_in_each_way(directory: Path, runs: int) -> dict[str, Path]:
    """Make the first `runs` runs of the recipe in each way, beside `directory`. Return the sets by way.

    Raises RuntimeError where two ways have other motions: only what sensors feel may differ.
    """
    made, labels = {}, []
    for number, (way, change) in enumerate(WAYS.items()):
        recipe = tomllib.loads((RECIPES / f"{RECIPE}.toml").read_text(encoding="utf-8"))
        change(recipe)
        made[way] = directory.with_name(f"{directory.name}-{runs}-{number}")
        rubgen.generate(recipe, made[way], runs=runs, progress=True)
        labels.append(rubgen.open(made[way]).runs[["status", "rub", "contact_impulse_per_turn_n_s"]])
    if not all(each.equals(labels[0]) for each in labels):
        raise RuntimeError(f"{directory}: the ways do not have the same motions")
    return made


def scores_of_each_way(made: dict[str, Path]) -> str:
    """A table of the scores by group of each way."""
    rows, header = [], ["the recipe", "task", "metric", *MODELS]
    for way, path in made.items():
        for each in baselines(path, WAY_TASKS, workers=usable_cores())[0]:
            metric = next(iter(TASKS[each.task].metrics))
            scores = [each.scores[model][BY_GROUP][metric] for model in MODELS]
            rows.append([way, each.task, metric, *(f"{mean:.2f} ± {spread:.2f}" for mean, spread in scores)])
    return table(header, sorted(rows, key=lambda row: WAY_TASKS.index(row[1])), numbers_from=3)


def main() -> None:
    """Score the set, or the first runs in each way, and write the page."""
    parser = argparse.ArgumentParser(prog="python -m validation.benchmark")
    parser.add_argument("directory", type=Path)
    parser.add_argument("--ways", type=int, metavar="N", help="make and score only the first N runs in each way")
    given = parser.parse_args()
    if given.ways:
        ways = scores_of_each_way(made_in_each_way(given.directory, given.ways))
        _fill("ways", f"Of {given.ways} runs, by group:\n\n{ways}")
        return
    found, reasons = baselines(given.directory, workers=usable_cores())
    impossible = "".join(f"\n- {name}: not possible: {reason}" for name, reason in reasons.items())
    _fill("baselines", results(rubgen.open(given.directory), found, load_recipe(RECIPE).runs) + impossible)


def _fill(name: str, text: str) -> None:
    write_text(PAGE, with_tables(PAGE.read_text(encoding="utf-8"), {name: text}))


if __name__ == "__main__":
    main()
