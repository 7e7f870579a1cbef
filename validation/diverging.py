"""`python -m validation.diverging`: which change keeps a run of the preset in range that otherwise diverges.

Of two designs it draws runs until so many have diverged, a blade first in one, the casing first in the other. Each is
run again with one change at a time. The counts go to `docs/status.md`. The reason of a diverged run names three of
them; a test holds it to the page. Runs are kept in `out/diverging/`, so that the command goes on where it was stopped.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from rubgen.dataset.making.workers import usable_cores
from rubgen.progress import count
from rubgen.reduction import reduce
from rubgen.scenario import Recipe, Scenario, parse_recipe
from rubgen.scenario.vary import PARAMETERS, vary
from rubgen.solver import Status
from rubgen.solver.integrate import integrate
from validation.command import run_command
from validation.markdown import table, with_tables
from validation.piece import Arrays, Found, Piece
from validation.store import Store

PAGE, PART, CONTROL_PART = "docs/status.md", "diverging", "diverging-control"
WANTED = 24
"""Diverged runs of each design."""
BATCH = 8
"""Draws that are made before diverged ones are counted."""
MOST_DRAWS = 256
CONTROL_DRAWS = 128
AROUND = {
    "speed_rpm": {"uniform": [7000, 11500]},
    "clearance_m": {"uniform": [1.2e-4, 2e-4]},
    "ovality_m": {"uniform": [6e-3, 12e-3]},
}
TIGHT = {
    **AROUND,
    "friction": {"uniform": [0.05, 0.1]},
    "casing_support_stiffness_n_per_m": {"log_uniform": [1e5, 2e6]},
    "casing_thickness_m": {"uniform": [1.3e-3, 4e-3]},
}
SOFT = {
    **AROUND,
    "friction": {"uniform": [0.0, 0.02]},
    "casing_support_stiffness_n_per_m": {"log_uniform": [3e3, 5e4]},
    "casing_thickness_m": {"uniform": [5e-4, 1.5e-3]},
    "unbalance_kg_m": {"uniform": [0.015, 0.06]},
}
CONTROL = {**AROUND, "friction": {"uniform": [0.05, 0.1]}}
DESIGNS = {"blade": TIGHT, "casing": SOFT}
"""By the part that leaves its range first in the runs that are counted."""
_KEYS = {parameter.key: parameter for parameter in PARAMETERS}

Change = Callable[[Scenario], Scenario]


def _scaled(key: str, factor: float, scenario: Scenario) -> Scenario:
    return vary(scenario, {key: factor * _KEYS[key].read(scenario)})


def _damped(part: str, factor: float, scenario: Scenario) -> Scenario:
    damping = scenario.machine.damping
    more: Any = {part: factor * getattr(damping, part)}
    return replace(scenario, machine=replace(scenario.machine, damping=replace(damping, **more)))


CHANGES: Mapping[str, Change] = {
    "friction 0.02": lambda scenario: vary(scenario, {"friction": 0.02}),
    "friction / 4": partial(_scaled, "friction", 1 / 4),
    "friction / 2": partial(_scaled, "friction", 1 / 2),
    "casing support stiffness / 4": partial(_scaled, "casing_support_stiffness_n_per_m", 1 / 4),
    "casing support stiffness x 4": partial(_scaled, "casing_support_stiffness_n_per_m", 4),
    "unbalance / 2": partial(_scaled, "unbalance_kg_m", 1 / 2),
    "damping of the blades x 4": partial(_damped, "blade", 4),
    "damping of the casing x 4": partial(_damped, "casing", 4),
    "lateral damping x 2": partial(_damped, "lateral", 2),
    "casing thickness x 2": partial(_scaled, "casing_thickness_m", 2),
    "casing thickness / 2": partial(_scaled, "casing_thickness_m", 1 / 2),
    "clearance x 2": partial(_scaled, "clearance_m", 2),
    "ovality / 2": partial(_scaled, "ovality_m", 1 / 2),
}


@dataclass(frozen=True, kw_only=True)
class Counted:
    """What became of the runs of one design."""

    draws: int
    """Draws up to the last diverged run that is counted."""
    diverged: int
    in_range: Mapping[str, int]
    """By the change, of the diverged runs."""


def design(ranges: Mapping[str, object]) -> Recipe:
    """The recipe that draws runs of a design."""
    return parse_recipe({"name": "diverging", "runs": MOST_DRAWS, "machine": "zeng2019", "vary": dict(ranges)})


def run_piece(scenario: Scenario) -> Piece:
    """The piece that runs a scenario. The advice that is counted here changes no run."""
    return Piece(run, (scenario,), apart="solver/observers/divergence.py")


def run(scenario: Scenario) -> Arrays:
    """Which part left its range: "blade" or "casing"; "" of a run that ended well, else the status."""
    model = reduce(scenario.machine, scenario.reduction)
    response = integrate(model, scenario.operation, scenario.contact)
    if response.status is Status.DIVERGED:
        return {"left": np.array("casing" if response.reason.startswith("the casing") else "blade")}
    return {"left": np.array("" if response.status is Status.OK else response.status.code)}


def left(found: Found, scenario: Scenario) -> str:
    """The part that left its range in a run that has been made."""
    return str(found(run_piece(scenario))["left"])


def diverged(part: str, recipe: Recipe, found: Found, drawn: int) -> list[int]:
    """The first WANTED of the draws made so far in which that part left its range first."""
    return [index for index in range(drawn) if left(found, recipe.scenario(index)) == part][:WANTED]


def study(store: Store, workers: int) -> dict[str, Counted]:
    """Make what is missing of both designs and count."""
    counted = {}
    for part, ranges in DESIGNS.items():
        recipe, drawn, runs = design(ranges), 0, list[int]()
        while len(runs) < WANTED and drawn < MOST_DRAWS:
            drawn += BATCH
            store.compute([run_piece(recipe.scenario(index)) for index in range(drawn)], workers, count)
            runs = diverged(part, recipe, store, drawn)
        changed = {name: [change(recipe.scenario(index)) for index in runs] for name, change in CHANGES.items()}
        store.compute([run_piece(each) for again in changed.values() for each in again], workers, count)
        in_range = {name: sum(not left(store, each) for each in again) for name, again in changed.items()}
        counted[part] = Counted(draws=runs[-1] + 1, diverged=len(runs), in_range=in_range)
    return counted


def control(store: Store, workers: int) -> int:
    """Make draws with the preset's support and thickness; return in how many a part left its range."""
    recipe = design(CONTROL)
    scenarios = [recipe.scenario(index) for index in range(CONTROL_DRAWS)]
    store.compute(map(run_piece, scenarios), workers, count)
    return sum(left(store, each) in DESIGNS for each in scenarios)


def part_of_page(counted: Mapping[str, Counted]) -> str:
    """The counts of both designs and the table."""
    tight, soft = (counted[part] for part in DESIGNS)
    rows = [[name, *(str(counted[part].in_range[name]) for part in DESIGNS)] for name in CHANGES]
    every = tight.diverged + soft.diverged
    return f"""
- Tight, stiff casings: friction 0.05 to 0.1, support 1e5 to 2e6 N/m at each node, thickness 1.3 to 4 mm. A blade left
  its range first in {tight.diverged} of {tight.draws} draws.
- Soft, thin casings with a heavy unbalance: friction up to 0.02, support 3e3 to 5e4 N/m, thickness 0.5 to 1.5 mm,
  unbalance 0.015 to 0.06 kg m. The casing left its range first in {soft.diverged} of {soft.draws} draws.

Each of these {every} runs was repeated with one change at a time. The table shows how many of the {tight.diverged} runs
of each design then stayed in range. The reason of a diverged run names three of these changes for its part.

{table(["change", "a blade diverged", "the casing diverged"], rows)}
""".strip()


def control_text(number: int) -> str:
    """The sentence on the draws without a change of support and thickness."""
    kept = "With the support and the thickness of the preset and friction of 0.05 to 0.1"
    return f"{kept}, {number} of {CONTROL_DRAWS} draws diverged."


def _write(page: Path, part: str, text: str) -> None:
    page.write_text(with_tables(page.read_text(encoding="utf-8"), {part: text}), encoding="utf-8")


def main(arguments: Sequence[str], folder: Path) -> int:
    """Make what is missing, count, write the part of the page; paths start from `folder`."""
    parser = argparse.ArgumentParser(prog="python -m validation.diverging")
    parser.add_argument("--workers", type=int, default=usable_cores(), help="number of processes")
    given = parser.parse_args(arguments)
    store = Store(folder / "out/diverging")

    def work() -> None:
        with store.claimed():
            _write(folder / PAGE, PART, part_of_page(study(store, given.workers)))
            _write(folder / PAGE, CONTROL_PART, control_text(control(store, given.workers)))

    return run_command("validation.diverging", store.root, work)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], Path()))
