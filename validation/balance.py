"""`make balance`: a balanced set beside one that is drawn without balance; the tables of docs/balance.md.

Both sets are kept in `out/balance/`, so that the command goes on where it was stopped.
"""

from __future__ import annotations

import sys
import time
import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

import rubgen
from rubgen.balancing.screen import screen
from rubgen.dataset.reading.open import DataSet
from rubgen.pipeline import simulate
from rubgen.scenario import Recipe, parse_recipe
from rubgen.scenario.load import RECIPES
from validation.command import run_command
from validation.markdown import with_tables

RUNS = 48
"""Runs of each of the two sets."""
TIMED = 12
"""Candidates that are timed."""
CLASSES = ("no rub", "period-1", "period-k", "quasi-periodic", "chaotic", "undecided")


def main(folder: Path) -> int:
    """Make both sets where they are missing, and write the tables into docs/balance.md; paths start from `folder`."""
    root = folder / "out/balance"

    def work() -> None:
        data = tomllib.loads((RECIPES / "balanced.toml").read_text(encoding="utf-8")) | {"runs": RUNS}
        recipe = parse_recipe(data)
        balanced = _made(recipe, root / "balanced")
        plain = {key: value for key, value in data.items() if key != "balance"}
        drawn = _made(parse_recipe({**plain, "seed": recipe.seed + 1}), root / "drawn")
        tables = {
            "classes": classes(balanced),
            "agreement": agreement(balanced),
            "shares": shares(balanced, drawn),
            "cost": cost(recipe),
        }
        page = folder / "docs/balance.md"
        page.write_text(with_tables(page.read_text(encoding="utf-8"), tables), encoding="utf-8")

    return run_command("validation.balance", root, work)


def _made(recipe: Recipe, directory: Path) -> DataSet:
    rubgen.generate(recipe, directory)
    return rubgen.open(directory)


def classes(data: DataSet) -> str:
    """Each class of the balanced set: its share asked and natural, runs, candidates."""
    lines = ["| class | wanted | natural | runs | candidates | accepted | weight |", "|---|---|---|---|---|---|---|"]
    for row in _records(data.balance):
        accepted = format(row["runs"] / row["tries"], ".2f") if row["tries"] else ""
        weight = "" if np.isnan(row["weight"]) else f"{row['weight']:.2f}"
        lines.append(
            f"| {row['cell']} | {row['wanted']:.3f} | {row['natural']:.3f} | {row['runs']} | {row['tries']} | "
            f"{accepted} | {weight} |"
        )
    return "\n".join(lines)


def _records(table: pd.DataFrame) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = table.to_dict("records")  # type: ignore[assignment]
    return rows


def final_class(runs: pd.DataFrame) -> pd.Series[str]:
    """The class of each good run by its label: no rub, or the motion of a rub."""
    return runs["motion"].astype(str).where(runs["rub"].astype(bool), "no rub")


def agreement(data: DataSet) -> str:
    """How often the label of the whole run is the class that screening found."""
    good = data.ok
    wanted = good["balance_cell"].astype(str).str.replace(r", speed .*", "", regex=True)
    final = final_class(good)
    lines = ["| screened as | runs | label of the whole run is in the class | labels |", "|---|---|---|---|"]
    for name, labels in final.groupby(wanted):
        motion = str(name).removeprefix("rub, ")
        named = {"period-1", "chaotic"}
        inside = labels.isin([motion]) if motion != "other motion" else ~labels.isin({"no rub", *named})
        counts = ", ".join(f"{count} {each}" for each, count in labels.value_counts().items())
        lines.append(f"| {name} | {len(labels)} | {inside.sum()} | {counts} |")
    return "\n".join(lines)


def shares(balanced: DataSet, drawn: DataSet) -> str:
    """Weighted shares of labels in the balanced set beside the shares of the set without balance."""
    weights = balanced.weights[balanced.ok.index].to_numpy()
    final, plain = final_class(balanced.ok), final_class(drawn.ok)
    head = "| label | share in the balanced set | weighted | drawn without balance | difference over its error |"
    lines = [head, "|---|---|---|---|---|"]
    cells = balanced.ok["balance_cell"].astype(str)
    for name in CLASSES:
        here, there = (final == name).to_numpy(dtype=float), (plain == name).to_numpy(dtype=float)
        share = float(np.average(here, weights=weights))
        error = _stratified_error(here, weights, cells, balanced.balance)
        other = float(there.mean())
        spread = np.sqrt((other * (1 - other) + 0.25 / len(there)) / len(there))
        z = (share - other) / np.hypot(error, spread)
        lines.append(
            f"| {name} | {here.mean():.3f} | {share:.3f} ± {error:.3f} | {other:.3f} ± {spread:.3f} | {z:+.1f} |"
        )
    return "\n".join(lines)


def _stratified_error(here: np.ndarray, weights: np.ndarray, cells: pd.Series[str], table: pd.DataFrame) -> float:
    """Standard error of a weighted share: of the labels within each class, and of the natural share of the class.

    Of n runs a share p has the error sqrt((p (1 - p) + 1 / (4 n)) / n), so that a share of 0 has one too. The natural
    share of a class with n accepted candidates has the relative error 1 / sqrt(n) at most.
    """
    total, variance = weights.sum(), 0.0
    for row in _records(table):
        inside = (cells == row["cell"]).to_numpy()
        count = int(inside.sum())
        if not count:
            continue
        part, mean = weights[inside].sum() / total, float(here[inside].mean())
        variance += part**2 * ((mean * (1 - mean) + 0.25 / count) / count + mean**2 * (1 - part) / count)
    return float(np.sqrt(variance))


def cost(recipe: Recipe) -> str:
    """CPU seconds of a candidate by statics, by a short run, and of a whole run; the mean over rubbing candidates."""
    candidates = (recipe.candidate(index, 1) for index in range(1000))
    rubbing = []
    for candidate in candidates:
        verdict = screen(candidate, motion=False)
        if verdict is not None and verdict.rub:
            rubbing.append(replace(candidate, balance=None))
        if len(rubbing) == TIMED:
            break
    simulate(rubbing[0])  # compiles
    ways: dict[str, Callable[..., object]] = {
        "statics: whether it rubs": lambda one: screen(one, motion=False),
        "short run: its class of motion": lambda one: screen(one, motion=True),
        "the whole run, with signals and labels": simulate,
    }
    lines = ["| of a rubbing candidate | CPU s, mean |", "|---|---|"]
    for name, way in ways.items():
        start = time.process_time()
        for one in rubbing:
            way(one)
        lines.append(f"| {name} | {(time.process_time() - start) / len(rubbing):.2f} |")
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main(Path()))
