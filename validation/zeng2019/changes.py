"""The tally before this way of judging and after it, with the reason of every verdict that changed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from validation.rows import Row, read_rows
from validation.zeng2019.runs.region import WITH_TIPS
from validation.zeng2019.statement import AGREES, DIFFERS, UNKNOWABLE, Statement

BEFORE = Path(__file__).parent / "before.json"
"""Verdicts of version 0.1.0: rows of `section`, `statement`, `verdict`, `experiment`."""
KINDS = (AGREES, f"{AGREES} within", DIFFERS, UNKNOWABLE)
AT_CENTRE = "judged at the disk centre, as in the paper, and no longer by the worst of disk centre and tips"
APART = "a hypothesis of ours, no statement of the paper: no longer counted"
RUNS = "the run changed, not the rule"
Verdicts = dict[tuple[str, str], Statement]
"""Statements with the preset by title of the section and text."""


def kind(verdict: str) -> str:
    """The verdict without its numbers."""
    return KINDS[1] if verdict.startswith(KINDS[1]) else verdict


def tally(verdicts: Verdicts) -> list[list[str]]:
    """Rows of the numbers of verdicts before, with and without experiments, and after."""
    before = read_rows(BEFORE)
    groups = {
        "before, experiments of ours included": [row["verdict"] for row in before],
        "before, the paper's statements": [row["verdict"] for row in before if not row["experiment"]],
        "after": [one.verdict for one in verdicts.values() if not one.apart],
    }
    made = []
    for name, every in groups.items():
        counts = Counter(map(kind, every))
        made.append([name, *(str(counts[each]) for each in KINDS), str(len(every))])
    return made


def changed(verdicts: Verdicts) -> Sequence[Sequence[str]]:
    """Section, statement, verdict before and after, and the reason, of each that moved to another kind."""
    rows = []
    for row in read_rows(BEFORE):
        one = verdicts.get((row["section"], row["statement"]))
        after = "not counted" if row["experiment"] else one.verdict if one else "not asked any more"
        if kind(row["verdict"]) != kind(after):
            rows.append((row["section"].split(":")[0], row["statement"], row["verdict"], after, _reason(row, verdicts)))
    return rows


def _reason(row: Row, verdicts: Verdicts) -> str:
    if row["experiment"]:
        return APART
    return AT_CENTRE if (row["section"], f"{row['statement']} {WITH_TIPS}") in verdicts else RUNS
