"""How the motion in a range of a sweep is compared with the paper's words."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from validation.zeng2019.runs.measures import class_counts, height, is_regular, looks_regular, motion_of
from validation.zeng2019.runs.outcome import Outcome
from validation.zeng2019.statement import AGREES, DIFFERS, UNKNOWABLE, Statement, by_share

SEEN = 0.05
"""A class belongs to those among which a motion switches when at least this share of the runs has it."""
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
) -> Statement:
    """That a part moves in one way throughout, period-1 or chaotic: how many runs do."""
    good = [run for run in runs.values() if run.ok]
    true = sum(motion_of(run, part) in MEMBERS[word] for run in good)
    verdict = by_share(true, len(good))
    return Statement(
        statement=f"{where}: the {part} moves in {word} motion.",
        verdict=verdict,
        found=_found(runs, part, every),
        why=" ".join(filter(None, (_by_eye(word, part, good, every, verdict), why))),
        used_for_fitting=fitted,
    )


def _by_eye(word: str, part: str, good: Sequence[Outcome], every: Collection[Outcome], verdict: str) -> str:
    """What the verdict would be by the scatter of the 49 points, where that is another one."""
    full = height(every, part)
    points = sum(looks_regular(run, part, full) for run in good)
    other = by_share(points if word == PERIODIC else len(good) - points, len(good))
    return f"By the scatter of 49 points, the paper's way, the verdict would be `{other}`." if other != verdict else ""


def switching(
    where: str, words: tuple[str, ...], part: str, runs: dict[float, Outcome], every: Collection[Outcome], why: str = ""
) -> Statement:
    """That a part switches among some ways to move: whether each of them occurs.

    Quasi-periodic motion counts for one word alone, multi-period where that is among them.
    """
    good = [run for run in runs.values() if run.ok]
    meant = MEMBERS | ({CHAOTIC: ("chaotic",)} if MULTIPLE in words else {})
    shares = {word: sum(motion_of(run, part) in meant[word] for run in good) for word in words}
    missing = [word for word, count in shares.items() if count < SEEN * len(good)]
    named = f"{', '.join(words[:-1])} and {words[-1]}"
    return Statement(
        statement=f"{where}: the {part} switches {'among' if len(words) > 2 else 'between'} {named} motion.",
        verdict=UNKNOWABLE if not good else DIFFERS if missing else AGREES,
        found=_found(runs, part, every) + (f"; {' and '.join(missing)} too rare" if missing else ""),
        why=why,
    )


def _found(runs: dict[float, Outcome], part: str, every: Collection[Outcome]) -> str:
    if not runs:
        return "no value of this range is run at this size"
    full = height(every, part)
    good = [run for run in runs.values() if run.ok]
    seen = sum(looks_regular(run, part, full) for run in good)
    regular = sum(is_regular(motion_of(run, part)) for run in good)
    eye = f"; to the eye, {seen} of {len(good)} show one point" if seen != regular else ""
    return class_counts(runs.values(), part) + eye
