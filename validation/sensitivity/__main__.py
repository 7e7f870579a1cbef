"""`python -m validation.sensitivity [NAME ...] [--quick] [--finished] [--workers N]`: studies, figures, the page.

Names are those of the studies, `halving` and `recipes`; all by default. Runs and tables go to `out/sensitivity/`,
figures, `sensitivity.md` and, of `recipes`, `confidence.md` to `docs/`; with `--quick`, few values and turns,
everything goes to `out/sensitivity-quick/`. A study that was stopped goes on where it stood. A page shows every study
that is finished, and of `halving` and `recipes` what is finished; with `--finished` nothing more is run.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from rubgen.dataset.making.workers import usable_cores
from rubgen.progress import count
from rubgen.scenario import Scenario
from rubgen.viz.figures import save_png
from validation.command import run_command
from validation.piece import Arrays, Piece
from validation.rows import write_rows
from validation.sensitivity.cases import STUDIES, Study, with_operation
from validation.sensitivity.confidence_figure import reliability_figure
from validation.sensitivity.confidence_page import confidence_page
from validation.sensitivity.figures import halving_figure, study_figure
from validation.sensitivity.halving import SPEEDS_RPM, STEPS, Pair, halve, next_record, scenario
from validation.sensitivity.outcome import Outcome, outcome_of, run_piece
from validation.sensitivity.page import page
from validation.sensitivity.recipes import RUNS, SEEDS, Halved, RecipeRun, all_runs, halved, rubbing
from validation.sensitivity.results import Result, Results, varied
from validation.store import Store

HALVING, RECIPES = "halving", "recipes"
QUICK_SETTLE, QUICK_RECORD = 60, 64
QUICK_SPEEDS = SPEEDS_RPM[36::20]
QUICK_RUNS = 1
BLOCK = 80
"""Runs of recipes that are made with both steps before the next ones."""


@dataclass(frozen=True)
class Finished:
    """What of the studies, at their full or their quick size, a store holds."""

    store: Store
    quick: bool

    def shorten(self, asked: Scenario) -> Scenario:
        """The scenario with the turns of this size."""
        return with_operation(asked, settle_turns=QUICK_SETTLE, record_turns=QUICK_RECORD) if self.quick else asked

    def outcome(self, asked: Scenario) -> Outcome | None:
        """The outcome of a run; None where it is not finished."""
        piece = run_piece(asked)
        return outcome_of(self.store(piece)) if self.store.holds(piece) else None

    def scenarios(self, study: Study) -> dict[tuple[str, int], Scenario]:
        """The runs of a study by case and value."""
        return varied(study, study.quick if self.quick else study.values, self.shorten)

    @property
    def speeds(self) -> Sequence[float]:
        """Speeds at which the step is halved, rev/min."""
        return QUICK_SPEEDS if self.quick else SPEEDS_RPM

    def results(self, study: Study) -> Results:
        """The results of a study; none unless all of its runs are finished."""
        found = {key: self.outcome(asked) for key, asked in self.scenarios(study).items()}
        results = [Result(case=name, value=value, outcome=one) for (name, value), one in found.items() if one]
        return results if len(results) == len(found) else []

    def pairs(self) -> list[Pair]:
        """The pairs at the speeds that are finished."""
        return halve(self.outcome, self.speeds, self.shorten)

    def found(self, piece: Piece) -> Arrays | None:
        """The arrays of a piece; None where it is not finished."""
        return self.store(piece) if self.store.holds(piece) else None

    @property
    def runs(self) -> list[RecipeRun]:
        """The runs of the recipes."""
        return all_runs(QUICK_RUNS if self.quick else RUNS, self.shorten)

    def halved(self) -> dict[str, list[Halved]]:
        """The pairs of recipes that are finished, by the use of their seed; none without any."""
        pairs = halved(self.found, self.runs)
        return {use: [pair for pair in pairs if pair.run.use == use] for use in SEEDS} if pairs else {}


def main(arguments: Sequence[str], folder: Path) -> int:
    """Run the studies that are named, all by default; paths start from `folder`."""
    asked = _parse(arguments)
    out = folder / "out" / ("sensitivity-quick" if asked.quick else "sensitivity")
    finished = Finished(Store(out), asked.quick)

    def work() -> None:
        with finished.store.claimed():
            if not asked.finished:
                _compute(finished, asked.names, asked.workers)
            _write(finished, out, out if asked.quick else folder / "docs")

    return run_command("validation.sensitivity", out, work)


def _parse(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m validation.sensitivity")
    names = [*(study.name for study in STUDIES), HALVING, RECIPES]
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(names))
    parser.add_argument("--quick", action="store_true", help="few values and turns, into out/sensitivity-quick")
    parser.add_argument("--finished", action="store_true", help="show what is finished already, run nothing more")
    parser.add_argument("--workers", type=int, default=usable_cores(), help="number of processes")
    asked = parser.parse_args(arguments)
    unknown = [name for name in asked.names if name not in names]
    if unknown:
        parser.error(f"no study {unknown[0]!r}; choose from {', '.join(names)}")
    asked.names = asked.names or names
    return asked


def _compute(finished: Finished, names: Sequence[str], workers: int) -> None:
    runs = [run for study in STUDIES if study.name in names for run in finished.scenarios(study).values()]
    if HALVING in names:
        runs += [finished.shorten(scenario(rpm, steps)) for rpm in finished.speeds for steps in (STEPS, 2 * STEPS)]
    finished.store.compute(map(run_piece, runs), workers, count)
    if HALVING in names:
        later = [next_record(pair, finished.shorten) for pair in finished.pairs() if not pair.equal]
        finished.store.compute(map(run_piece, later), workers, count)
    if RECIPES in names:
        for first in range(0, len(finished.runs), BLOCK):  # so that a study that is stopped has pairs
            block = finished.runs[first : first + BLOCK]
            finished.store.compute((run.piece(STEPS) for run in block), workers, count)
            again = rubbing(finished.found, block)
            finished.store.compute((run.piece(2 * STEPS) for run in again), workers, count)


def _write(finished: Finished, out: Path, pictures: Path) -> None:
    results = dict(_studies(finished))
    for study in STUDIES:
        if study.name in results:
            write_rows(out / f"{study.name}.json", [result.as_dict() for result in results[study.name]])
            save_png(study_figure(study, results[study.name]), pictures / f"sensitivity-{study.name}.png")
    pairs = finished.pairs()
    if pairs:
        write_rows(out / f"{HALVING}.json", [asdict(pair) for pair in pairs])
        save_png(halving_figure(pairs), pictures / f"sensitivity-{HALVING}.png")
    recipes = finished.halved()
    if recipes:
        save_png(reliability_figure(recipes), pictures / "confidence.png")
        (pictures / "confidence.md").write_text(confidence_page(recipes), encoding="utf-8")
    if results or pairs:
        (pictures / "sensitivity.md").write_text(page(results, pairs), encoding="utf-8")


def _studies(finished: Finished) -> Iterator[tuple[str, Results]]:
    for study in STUDIES:
        results = finished.results(study)
        if results:
            yield study.name, results


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], Path()))
