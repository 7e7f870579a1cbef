"""The study of diverging runs: what it changes and counts; and the reason of such a run says what it found."""

import re
from pathlib import Path

import numpy as np
import pytest

from rubgen.scenario import make_scenario
from rubgen.scenario.scenario import scenario_dict
from rubgen.solver.observers.divergence import ADVICE
from validation import diverging
from validation.diverging import CHANGES, DESIGNS, Counted, part_of_page, study

PAGE = (Path(__file__).parents[2] / diverging.PAGE).read_text(encoding="utf-8")
CHANGE_OF = {
    "friction 0.02": "friction 0.02",
    "a quarter of the casing's support stiffness": "casing support stiffness / 4",
    "four times the damping of the blades": "damping of the blades x 4",
    "four times the casing's support stiffness": "casing support stiffness x 4",
    "half the unbalance": "unbalance / 2",
    "four times the damping of the casing": "damping of the casing x 4",
}
"""The words of the reason, and the row of the table."""


def table_of(page):
    """The counts of the table by change, one for each design."""
    rows = re.findall(r"^\| ([^|]+) \| (\d+|-) \| (\d+|-) \|$", page, re.MULTILINE)
    return {name: dict(zip(DESIGNS, counts, strict=True)) for name, *counts in rows}


@pytest.mark.parametrize(("part", "diverged"), [("blade", "A blade left"), ("casing", "The casing left")])
def test_the_reason_of_a_diverged_run_has_the_counts_of_the_page(part, diverged):
    counts = table_of(PAGE)
    of, first, _, rest = re.fullmatch(r"of (\d+) such runs of the preset (\d+) (.+?) with (.*)", ADVICE[part]).groups()
    told = [f"{first} with {rest.partition(', ')[0]}", *rest.removesuffix(" (docs/status.md)").split(", ")[1:]]
    assert len(told) == 3
    for each in told:
        count, _, words = each.partition(" with ")
        assert counts[CHANGE_OF[words]][part] == count
    assert re.search(rf"{diverged}\s+its\s+range\s+first\s+in\s+{of} of \d+ draws", PAGE)


@pytest.mark.parametrize("name", CHANGES)
def test_a_change_is_one_change(name):
    before = make_scenario("zeng2019", friction=0.08)
    changed = differences(scenario_dict(before), scenario_dict(CHANGES[name](before)))
    places = 2 if name.startswith("casing support") else 1  # radial and circumferential
    assert len(changed) == places
    factor = {"/ 2": 1 / 2, "/ 4": 1 / 4, "x 2": 2, "x 4": 4}.get(name[-3:])
    for old, new in changed:
        assert new == pytest.approx(factor * old if factor else 0.02)


def differences(one, other):
    if isinstance(one, dict):
        return [each for key in one for each in differences(one[key], other[key])]
    return [] if one == other else [(one, other)]


def test_runs_are_counted_of_the_draws_that_diverged_as_asked(tmp_path, monkeypatch):
    """Of every three draws one diverges as asked; of these every second is kept in range by half the unbalance."""
    monkeypatch.setattr(diverging, "WANTED", 4)
    known = {}
    for part, ranges in DESIGNS.items():
        recipe = diverging.design(ranges)
        for index in range(16):
            scenario = recipe.scenario(index)
            known[diverging.run_piece(scenario).key] = part if index % 3 == 1 else "energy" if index % 3 else ""
            halved = CHANGES["unbalance / 2"](scenario)
            known[diverging.run_piece(halved).key] = "" if index % 2 else part

    class MadeUp:
        def compute(self, *_):
            return 0

        def __call__(self, piece):
            return {"left": np.array(known.get(piece.key, "blade"))}

    counted = study(MadeUp(), 1)
    assert {part: (each.draws, each.diverged) for part, each in counted.items()} == dict.fromkeys(DESIGNS, (11, 4))
    assert counted["casing"].in_range == {name: 2 if name == "unbalance / 2" else 0 for name in CHANGES}


def test_the_page_holds_the_counts():
    counted = {
        "blade": Counted(draws=30, diverged=24, in_range=dict.fromkeys(CHANGES, 7)),
        "casing": Counted(draws=60, diverged=23, in_range=dict.fromkeys(CHANGES, 8)),
    }
    text = part_of_page(counted)
    assert table_of(text) == {name: {"blade": "7", "casing": "8"} for name in CHANGES}
    assert "in 24 of 30 draws" in text
    assert "in 23 of 60 draws" in text
