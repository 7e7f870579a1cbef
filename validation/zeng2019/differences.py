"""The one main cause of each statement that differs, and the experiment that shows it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from validation.zeng2019.figures.figure20 import REGIONS as SUPPORT_REGIONS
from validation.zeng2019.fitting.score import Score
from validation.zeng2019.fitting.targets import ANY, TARGETS, Target
from validation.zeng2019.runs.cases import REGIONS
from validation.zeng2019.size import TWIN
from validation.zeng2019.statement import AGREES, HALF, Statement

SYMMETRY = "the paper contradicts symmetry"
REDUCTION = "tolerance of a reduction"
GEOMETRY = "contact geometry"
DIMENSION = "a lost dimension"
BOUND = "bound of a label"
WORDS = "reading of the words"
UNKNOWN = "not found"
MEANINGS = {
    SYMMETRY: "A machine whose blades are equal and whose casing has two equal lobes cannot do it.",
    REDUCTION: "The reduced basis is less accurate than the paper says, or its limit is another one than ours.",
    GEOMETRY: "Chords agree, and the same machine on the smooth curve does not.",
    DIMENSION: "Another value of what is not published agrees: mass, springs, damping or friction.",
    BOUND: "Another bound between two classes agrees, such as the eye's.",
    WORDS: "Another reading of the paper's sentence agrees, such as with the tips or at the values it names.",
    UNKNOWN: "No experiment of this page agrees.",
}
KNOWN = {
    "Four modes a blade": (REDUCTION, "Figure 6: the largest error falls with the number of modes a blade"),
    "86 modes of the blisk": (REDUCTION, "Figure 6: eight modes a blade in the first step change little"),
    "four blisk modes are as good": (REDUCTION, "Figure 6: the error against the full model grows with the speed"),
    "Another natural frequency": (SYMMETRY, "`causes`: one crossing in a consistent model, two in mixed frames"),
    "one stiffness, 1.4e8": (SYMMETRY, "`causes`: it lies between the two crossings of mixed frames"),
    "ven orders": (SYMMETRY, "`causes`: without the casing's odd shapes the point shows even orders only"),
    "casing's vibration is f_r times": (SYMMETRY, "`causes`: a point shows odd orders of the casing's odd shapes"),
}
"""Part of a statement, its cause, and the section of the page whose runs show it."""


@dataclass(frozen=True, kw_only=True)
class Cause:
    """A cause (a key of MEANINGS), and the experiment that shows it."""

    name: str
    experiment: str


def cause_of(one: Statement, chords: Statement | None, twin: Statement | None, search: Sequence[Score]) -> Cause:
    """The cause of a statement that differs; `chords` and `twin` are the verdicts of the other two machines."""
    for part, (name, shown) in KNOWN.items():
        if part in one.statement:
            return Cause(name=name, experiment=shown)
    if chords and chords.verdict.startswith(AGREES) and twin:
        if twin.verdict.startswith(AGREES):
            return Cause(name=DIMENSION, experiment=f"{TWIN}: {twin.verdict} ({twin.found})")
        return Cause(name=GEOMETRY, experiment=f"{TWIN}: {twin.verdict} ({twin.found})")
    if one.by_eye.startswith(AGREES):
        return Cause(name=BOUND, experiment=f"by {one.other_bound}: {one.by_eye}")
    if one.by_words.startswith(AGREES):
        return Cause(name=WORDS, experiment=f"{one.other_words}: {one.by_words}")
    if chords and twin and twin.verdict.startswith(AGREES):
        return Cause(
            name=DIMENSION, experiment=f"the casing of zeng2019-as-computed on the smooth curve: {twin.verdict}"
        )
    return _by_search(one, search)


def _by_search(one: Statement, search: Sequence[Score]) -> Cause:
    places = words_of(one.statement)
    if not places:
        return Cause(name=UNKNOWN, experiment="no machine that was run agrees")
    agree = [score for score in search if sum(score.hits[place] for place in places) >= HALF * len(places)]
    told = f"{len(agree)} of the {len(search)} candidates of the search confirm half or more of its {len(places)} words"
    return Cause(name=DIMENSION if agree else UNKNOWN, experiment=told)


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
