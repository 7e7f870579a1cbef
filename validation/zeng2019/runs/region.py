"""How the motion in a range of a sweep is compared with the paper's words."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace

import numpy as np

from validation.zeng2019.runs.measures import EYE, class_counts, height, looks_regular, motion_of, scatter
from validation.zeng2019.runs.outcome import Outcome
from validation.zeng2019.statement import AGREES, DIFFERS, TIPS, UNKNOWABLE, Statement, by_share, yes_or_no

SEEN = 0.05
"""A class belongs to those among which a motion switches when at least this share of the runs has it."""
WITH_TIPS = "(tips)"
"""Ends a statement on the blisk that is judged by the worst of disk centre and tips."""
PERIODIC, MULTIPLE, CHAOTIC = "period-1", "multi-period", "chaotic"
MEMBERS = {
    PERIODIC: ("period-1", "static"),
    MULTIPLE: ("period-k", "quasi-periodic"),
    CHAOTIC: ("chaotic", "quasi-periodic"),
}
"""The paper's three words, and our classes that they may mean: its 49 points cannot tell quasi-periodic motion."""


def one_class(
    where: str,
    word: str,
    part: str,
    runs: dict[float, Outcome],
    every: Collection[Outcome],
    why: str = "",
    *,
    fitted: bool = False,
) -> list[Statement]:
    """That a part moves in one way throughout, period-1 or chaotic: how many runs do. On the blisk, with the tips."""

    def judged(judged_part: str) -> tuple[str, str]:
        good = [run for run in runs.values() if run.ok]
        true = sum(motion_of(run, judged_part) in MEMBERS[word] for run in good)
        return by_share(true, len(good)), _found(runs, judged_part, every)

    verdict, found = judged(part)
    statement = f"{where}: the {part} moves in {word} motion."
    first = Statement(
        statement=statement,
        verdict=verdict,
        found=found,
        why=why,
        used_for_fitting=fitted,
        by_eye=_by_eye(word, part, [run for run in runs.values() if run.ok], every, verdict),
    )
    return with_tips(part, first, judged)


def switching(
    where: str, words: tuple[str, ...], part: str, runs: dict[float, Outcome], every: Collection[Outcome], why: str = ""
) -> list[Statement]:
    """That a part switches among some ways to move: whether each of them occurs. On the blisk, with the tips.

    Quasi-periodic motion counts for one word alone, multi-period where that is among them.
    """
    good = [run for run in runs.values() if run.ok]
    meant = MEMBERS | ({CHAOTIC: ("chaotic",)} if MULTIPLE in words else {})

    def rare(judged_part: str, least: float) -> list[str]:
        counts = {word: sum(motion_of(run, judged_part) in meant[word] for run in good) for word in words}
        return [word for word, count in counts.items() if count < least]

    def judged(judged_part: str) -> tuple[str, str]:
        missing = rare(judged_part, SEEN * len(good))
        told = f"; {' and '.join(missing)} too rare" if missing else ""
        return UNKNOWABLE if not good else DIFFERS if missing else AGREES, _found(runs, judged_part, every) + told

    named = f"{', '.join(words[:-1])} and {words[-1]}"
    verdict, found = judged(part)
    first = Statement(
        statement=f"{where}: the {part} switches {'among' if len(words) > 2 else 'between'} {named} motion.",
        verdict=verdict,
        found=found,
        why=why,
        by_eye=yes_or_no(not rare(part, 1)) if good and verdict == DIFFERS else "",
        other_bound=f"one run, not {100 * SEEN:.0f} % of them, as the bound of what occurs",
    )
    return with_tips(part, first, judged)


def with_tips(part: str, first: Statement, judged: Callable[[str], tuple[str, str]]) -> list[Statement]:
    """The statement, and for one on the blisk a row beside the tally: `judged` gives verdict and finding of a part."""
    if part != "blisk":
        return [first]
    verdict, found = judged("tips")
    if verdict != first.verdict:
        first = replace(first, by_words=verdict, other_words="judged by the disk centre and the tips")
    return [first, Statement(statement=f"{first.statement} {WITH_TIPS}", verdict=verdict, found=found, apart=TIPS)]


def _by_eye(word: str, part: str, good: Sequence[Outcome], every: Collection[Outcome], verdict: str) -> str:
    """The verdict by the scatter of the 49 points, the paper's way, where that is another one."""
    full = height(every, part)
    points = sum(looks_regular(run, part, full) for run in good)
    other = by_share(points if word == PERIODIC else len(good) - points, len(good))
    return other if other != verdict else ""


def _found(runs: dict[float, Outcome], part: str, every: Collection[Outcome]) -> str:
    """Classes, and for what has 49 points how far they scatter."""
    if not runs:
        return "no value of this range is run at this size"
    good, full = [run for run in runs.values() if run.ok], height(every, part) if part != "tips" else 0.0
    counts = class_counts(runs.values(), part)
    if not good or not full:
        return counts
    scatters = [100 * scatter(run, part, full) for run in good]
    seen = sum(looks_regular(run, part, full) for run in good)
    return (
        f"{counts}; 49 points scatter over {np.median(scatters):.2g} % of the height of the diagram (median; largest "
        f"{max(scatters):.2g} %), over less than {100 * EYE:.0f} % in {seen} of {len(good)}"
    )
