"""`python -m validation.sensitivity [NAME ...] [--quick] [--finished]`: studies, figures, `docs/sensitivity.md`.

Names are those of the studies and `halving`; all by default. Results go to `out/sensitivity/`, figures and the page to
`docs/`; with `--quick`, few values and turns, everything goes to `out/sensitivity-quick/`. A study that was stopped
goes on where it stood. `--finished` shows what is finished of `halving` and runs nothing more of it.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from rubgen.scenario import Scenario
from rubgen.viz.figures import save_png
from validation.sensitivity.cases import STUDIES, Study, with_operation
from validation.sensitivity.figures import halving_figure, study_figure
from validation.sensitivity.halving import SPEEDS_RPM, STEPS, halve, scenario
from validation.sensitivity.kept import KeptRuns
from validation.sensitivity.outcome import Outcome
from validation.sensitivity.page import page
from validation.sensitivity.results import (
    read_pairs,
    read_results,
    vary_number,
    write_pairs,
    write_results,
)

HALVING = "halving"
QUICK_SETTLE, QUICK_RECORD = 60, 64
QUICK_SPEEDS = SPEEDS_RPM[36::20]


def main(arguments: Sequence[str], folder: Path) -> int:
    """Run the studies that are named, all by default; paths start from `folder`."""
    asked = _parse(arguments)
    out = folder / "out" / ("sensitivity-quick" if asked.quick else "sensitivity")
    pictures = out if asked.quick else folder / "docs"
    kept, shorter = KeptRuns(out / "runs.jsonl"), _quick if asked.quick else _whole
    told = _told(kept)
    for study in STUDIES:
        if study.name in asked.names:
            _study(study, told, out, pictures, quick=asked.quick)
    if HALVING in asked.names:
        speeds = QUICK_SPEEDS if asked.quick else SPEEDS_RPM
        if asked.finished:
            speeds = tuple(speed for speed in speeds if _is_finished(kept, shorter, speed))
        pairs = halve(told, speeds, shorter)
        write_pairs(pairs, out / f"{HALVING}.json")
        save_png(halving_figure(pairs), pictures / f"sensitivity-{HALVING}.png")
    text = write_page(out)
    (pictures / "sensitivity.md").write_text(text, encoding="utf-8")
    return 0


def write_page(out: Path) -> str:
    """The page from the results of all studies that are there."""
    found = {study.name: out / f"{study.name}.json" for study in STUDIES}
    results = {name: read_results(path) for name, path in found.items() if path.exists()}
    pairs = out / f"{HALVING}.json"
    return page(results, read_pairs(pairs) if pairs.exists() else [])


def _parse(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m validation.sensitivity")
    names = [study.name for study in STUDIES] + [HALVING]
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(names))
    parser.add_argument("--quick", action="store_true", help="few values and turns, into out/sensitivity-quick")
    parser.add_argument("--finished", action="store_true", help="of halving, only what is finished already")
    asked = parser.parse_args(arguments)
    unknown = [name for name in asked.names if name not in names]
    if unknown:
        parser.error(f"no study {unknown[0]!r}; choose from {', '.join(names)}")
    asked.names = asked.names or names
    return asked


def _study(study: Study, outcome: Callable[[Scenario], Outcome], out: Path, pictures: Path, *, quick: bool) -> None:
    sys.stdout.write(f"\n{study.quantity}\n")
    results = vary_number(study, study.quick if quick else study.values, outcome, _quick if quick else _whole)
    write_results(results, out / f"{study.name}.json")
    save_png(study_figure(study, results), pictures / f"sensitivity-{study.name}.png")


def _told(kept: KeptRuns) -> Callable[[Scenario], Outcome]:
    """Runs a scenario and tells of it in a line."""

    def outcome(asked: Scenario) -> Outcome:
        found = kept.outcome(asked)
        where = f"{asked.operation.speed_rpm:6.0f} rev/min, {found.steps_per_turn:5d} steps, {found.dof} DoF"
        zones = f"{found.zones} zones, impulse {found.impulse:.4g} N s a turn"
        sys.stdout.write(f"  {where}, friction {asked.contact.friction:g}: {found.label}, {zones}\n")
        sys.stdout.flush()
        return found

    return outcome


def _is_finished(kept: KeptRuns, shorter: Callable[[Scenario], Scenario], speed_rpm: float) -> bool:
    return all(kept.holds(shorter(scenario(speed_rpm, steps))) for steps in (STEPS, 2 * STEPS))


def _whole(asked: Scenario) -> Scenario:
    return asked


def _quick(asked: Scenario) -> Scenario:
    return with_operation(asked, settle_turns=QUICK_SETTLE, record_turns=QUICK_RECORD)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], Path()))
