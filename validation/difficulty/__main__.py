"""`python -m validation.difficulty [--recipe FILE] [--runs N] [--workers N]`: runs, figure, page.

Runs are kept in `out/difficulty/`, so that the command goes on where it was stopped. Figure and page go to `docs/`, or
with other runs or another recipe to `out/difficulty/`.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from rubgen.dataset.making.workers import usable_cores
from rubgen.errors import UserError
from rubgen.progress import count
from rubgen.scenario import load_recipe
from rubgen.scenario.load import RECIPES
from rubgen.viz.figures import save_png
from validation.command import run_command
from validation.difficulty.figure import background_figure
from validation.difficulty.page import PLANT, accelerations, best_feature, page
from validation.difficulty.runs import cases, run_pieces
from validation.difficulty.scores import FOLDS, boosted
from validation.store import Store

RECIPE, RUNS = RECIPES / "field.toml", 400


def main(arguments: Sequence[str], folder: Path) -> int:
    """Make what is missing, score, draw, write; paths start from `folder`."""
    parser = argparse.ArgumentParser(prog="python -m validation.difficulty")
    parser.add_argument("--recipe", type=Path, default=RECIPE, help="the recipe of the runs")
    parser.add_argument("--runs", type=int, default=RUNS, help="number of runs")
    parser.add_argument("--workers", type=int, default=usable_cores(), help="number of processes")
    given = parser.parse_args(arguments)
    store = Store(folder / "out/difficulty")
    target = folder / "docs" if (given.recipe, given.runs) == (RECIPE, RUNS) else store.root

    def work() -> None:
        recipe = load_recipe(folder / given.recipe, runs=given.runs)
        with store.claimed():
            pieces = run_pieces(recipe)
            store.compute(pieces, given.workers, count)
            found = cases(recipe, [store(piece) for piece in pieces])
            if min(found.rub.sum(), (~found.rub).sum()) < FOLDS:
                raise UserError(f"--runs {given.runs}: {found.rub.sum()} rub; give so many that each class has {FOLDS}")
            learned = boosted(accelerations(found, PLANT), found.rub)
            save_png(background_figure(found, learned, best_feature(found)), target / "difficulty.png")
            (target / "difficulty.md").write_text(page(found, learned, recipe.name), encoding="utf-8")
            sys.stdout.write(f"{found.rub.size} runs, {found.rub.sum()} rub: {target / 'difficulty.md'}\n")

    return run_command("validation.difficulty", store.root, work)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], Path()))
