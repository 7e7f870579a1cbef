"""The one main cause of each statement that differs, and the experiment that shows it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from validation.zeng2019.figures.figure20 import REGIONS as SUPPORT_REGIONS
from validation.zeng2019.fitting.score import Score
from validation.zeng2019.fitting.targets import ANY, TARGETS, Target
from validation.zeng2019.meanings import BOUND, DIMENSION, GEOMETRY, REDUCTION, UNKNOWN, WORDS
from validation.zeng2019.runs.cases import REGIONS
from validation.zeng2019.size import AS_COMPUTED, MACHINE, TWIN
from validation.zeng2019.statement import AGREES, HALF, Statement

KNOWN = {
    "Four modes a blade": (REDUCTION, "Figure 6: the largest error falls with the number of modes a blade"),
    "86 modes of the blisk": (REDUCTION, "Figure 6: eight modes a blade in the first step change little"),
    "four blisk modes are as good": (REDUCTION, "Figure 6: the error against the full model grows with the speed"),
}
"""Part of a statement on the reduction, its cause, and the rows of figure 6 that show it."""


@dataclass(frozen=True, kw_only=True)
class Cause:
    """A cause (a key of MEANINGS), and the experiment that shows it."""

    name: str
    experiment: str


@dataclass(frozen=True, kw_only=True)
class Experiment:
    """A row that is `about` statements: its section, and what it found with the preset and with AS_COMPUTED."""

    section: str
    preset: Statement
    chords: Statement | None


def cause_of(
    one: Statement,
    chords: Statement | None,
    twin: Statement | None,
    search: Sequence[Score],
    experiments: Sequence[Experiment] = (),
) -> Cause:
    """The cause of a statement that differs; `chords` and `twin` are the verdicts of the other two machines."""
    return (
        _known(one)
        or _by_experiment(one, experiments)
        or _by_machine(chords, twin)
        or _otherwise(one, chords)
        or _by_twin(chords, twin)
        or _by_search(one, search)
        or _chords_otherwise(chords, twin)
        or Cause(name=UNKNOWN, experiment=_tried(one, search))
    )


def _known(one: Statement) -> Cause | None:
    found = next((cause for part, cause in KNOWN.items() if part in one.statement), None)
    return Cause(name=found[0], experiment=found[1]) if found else None


def _by_experiment(one: Statement, experiments: Sequence[Experiment]) -> Cause | None:
    """The first experiment about the statement that agrees with the preset."""
    for each in experiments:
        if any(part in one.statement for part in each.preset.about) and each.preset.verdict.startswith(AGREES):
            told = f'`{each.section}`, "{each.preset.statement.rstrip(".")}": {each.preset.verdict}'
            both = _with_chords(each.chords.verdict if each.chords else "")
            return Cause(name=each.preset.cause, experiment=told + both)
    return None


def _by_machine(chords: Statement | None, twin: Statement | None) -> Cause | None:
    if not (chords and twin and chords.verdict.startswith(AGREES)):
        return None
    name = DIMENSION if twin.verdict.startswith(AGREES) else GEOMETRY
    return Cause(name=name, experiment=f"{TWIN}: {twin.verdict} ({twin.found})")


def _otherwise(one: Statement, chords: Statement | None) -> Cause | None:
    """Another bound, then another reading, with which the preset agrees; and what the other machine has by it."""
    if one.by_eye.startswith(AGREES):
        told = f"by {one.other_bound}: {one.by_eye}"
        return Cause(name=BOUND, experiment=told + _with_chords(chords.by_eye or chords.verdict if chords else ""))
    if one.by_words.startswith(AGREES):
        told = f"{one.other_words}: {one.by_words}"
        return Cause(name=WORDS, experiment=told + _with_chords(chords.by_words or chords.verdict if chords else ""))
    return None


def _with_chords(verdict: str) -> str:
    return f"; with {AS_COMPUTED}: {verdict}" if verdict else ""


def _by_twin(chords: Statement | None, twin: Statement | None) -> Cause | None:
    if not (chords and twin and twin.verdict.startswith(AGREES)):
        return None
    return Cause(name=DIMENSION, experiment=f"the casing of {AS_COMPUTED} on the smooth curve: {twin.verdict}")


def _chords_otherwise(chords: Statement | None, twin: Statement | None) -> Cause | None:
    """Another bound or reading with which AS_COMPUTED agrees, though the preset does not."""
    if not (chords and twin):
        return None
    for told, here, there in (
        (f"by {chords.other_bound}", chords.by_eye, twin.by_eye or twin.verdict),
        (chords.other_words, chords.by_words, twin.by_words or twin.verdict),
    ):
        if here.startswith(AGREES):
            name = DIMENSION if there.startswith(AGREES) else GEOMETRY
            return Cause(name=name, experiment=f"{told}: {AS_COMPUTED} {here}; {TWIN} {there}; {MACHINE} differs")
    return None


def _tried(one: Statement, search: Sequence[Score]) -> str:
    """What was tried without success."""
    tried = [f"by {one.other_bound}: {one.by_eye}" if one.by_eye else "", one.other_words, "no machine that was run"]
    count = f"none of the {len(search)} candidates of the search" if words_of(one.statement) else ""
    return "nothing agrees that was tried: " + "; ".join(filter(None, [*tried, count]))


def _by_search(one: Statement, search: Sequence[Score]) -> Cause | None:
    places = words_of(one.statement)
    agree = [score for score in search if places and sum(score.hits[i] for i in places) >= HALF * len(places)]
    told = f"{len(agree)} of the {len(search)} candidates of the search confirm half or more of its {len(places)} words"
    return Cause(name=DIMENSION, experiment=told) if agree else None


def words_of(statement: str) -> list[int]:
    """Places in `targets.words(TARGETS)` of the words of the search that belong to the statement."""
    places, place = [], 0
    for target in TARGETS:
        for part, word in (("blisk", target.blisk), ("casing", target.casing)):
            if word == ANY:
                continue
            if f"the {part} moves in {word} motion" in statement and _where(target, statement):
                places.append(place)
            place += 1
    return places


def _where(target: Target, statement: str) -> bool:
    if target.casing_support is not None:
        name = next(n for n, ((low, high), *_) in SUPPORT_REGIONS.items() if low <= target.casing_support <= high)
        return statement.startswith("Casing support") and f"region {name}:" in statement
    if target.disk_support is not None:
        return statement.startswith("Disk support")
    region = next(name for name, (low, high) in REGIONS.items() if low <= target.speed_rpm <= high)
    return statement.startswith((f"Region {region}:", f"Region {region},"))
