"""How many of the paper's words a candidate of the search bears out, and which candidate is taken."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from validation.piece import Arrays, Found
from validation.zeng2019.fitting.search import ANY, FITTED, PRESET, TARGETS, Candidate, Target
from validation.zeng2019.runs.region import MEMBERS


@dataclass(frozen=True, kw_only=True)
class Score:
    """How many of the paper's words a candidate bears out: of those used, and of those predicted."""

    candidate: Candidate
    fitted: int
    predicted: int


def words(targets: Sequence[Target]) -> int:
    """How many words of the paper stand in the targets."""
    return sum((target.blisk != ANY) + (target.casing != ANY) for target in targets)


def score(candidate: Candidate, found: Found) -> Score:
    """How many of the words of FITTED and of PREDICTED are borne out."""
    fitted, predicted = borne_out(found(candidate.piece))
    return Score(candidate=candidate, fitted=fitted, predicted=predicted)


def always(motion: str) -> tuple[int, int]:
    """Words of FITTED and of PREDICTED that a machine bears out which moves in that way everywhere."""
    every = np.full(len(TARGETS), motion)
    return borne_out({"blisk": every, "casing": every})


def borne_out(seen: Arrays) -> tuple[int, int]:
    """Words of FITTED and of PREDICTED that these classes bear out."""
    hits = [
        [str(name) in MEMBERS[word] for name, word in ((blisk, target.blisk), (casing, target.casing)) if word != ANY]
        for target, blisk, casing in zip(TARGETS, seen["blisk"], seen["casing"], strict=True)
    ]
    counts = [sum(row) for row in hits]
    return sum(counts[: len(FITTED)]), sum(counts[len(FITTED) :])


def best(scores: Sequence[Score]) -> Score:
    """The candidate with the most fitted words; of equals the one that shares most values with the preset."""
    return max(scores, key=lambda one: (one.fitted, _kept(one.candidate)))


def _kept(one: Candidate) -> int:
    return (one.damping == PRESET.damping) + (one.mass == PRESET.mass) + (one.friction == PRESET.friction)


def frictionless(scores: Sequence[Score]) -> list[Score]:
    """The scores of candidates without friction: a machine carries none."""
    return [one for one in scores if one.candidate.friction == 0]
