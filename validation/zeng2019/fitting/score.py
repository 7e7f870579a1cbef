"""How well a candidate of the search bears out the paper's words, how sure that is, and which candidate is taken."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, dataclass

import numpy as np

from rubgen.arrays import FloatArray
from validation.piece import Arrays
from validation.zeng2019.fitting.candidate import PRESET, Candidate
from validation.zeng2019.fitting.targets import ANY, FITTED, PREDICTED, Target, words
from validation.zeng2019.runs.region import CHAOTIC, MEMBERS, PERIODIC

RESAMPLES, SEED = 2000, 2019
Hits = np.typing.NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True)
class Score:
    """Which words a candidate bears out, in the order of `words`: those of FITTED, and those held out."""

    candidate: Candidate
    fitted: tuple[bool, ...]
    predicted: tuple[bool, ...]

    @property
    def hits(self) -> tuple[bool, ...]:
        """All words, in the order of `words(TARGETS)`."""
        return self.fitted + self.predicted

    @property
    def accuracy(self) -> float:
        """Balanced accuracy on the words of FITTED."""
        return float(balanced(np.array([self.fitted]), words(FITTED))[0])

    @property
    def held_out(self) -> float:
        """Balanced accuracy on the words of PREDICTED."""
        return float(balanced(np.array([self.predicted]), words(PREDICTED))[0])


def score(candidate: Candidate, seen: Arrays) -> Score:
    """The score of a candidate whose motion is `seen`: `blisk` and `casing` at each of TARGETS."""
    hits = borne_out(seen)
    count = len(words(FITTED))
    return Score(candidate=candidate, fitted=tuple(hits[:count]), predicted=tuple(hits[count:]))


def borne_out(seen: Arrays) -> list[bool]:
    """For each word of FITTED and of PREDICTED whether these classes bear it out."""
    return [
        str(name) in MEMBERS[word]
        for target, blisk, casing in zip(FITTED + PREDICTED, seen["blisk"], seen["casing"], strict=True)
        for name, word in ((blisk, target.blisk), (casing, target.casing))
        if word != ANY
    ]


def always(motion: str, targets: Sequence[Target]) -> float:
    """Balanced accuracy of a machine that moves in that way everywhere: one half, if it is one of the two words."""
    asked = words(targets)
    return float(balanced(np.array([[motion in MEMBERS[word] for word in asked]]), asked)[0])


def balanced(hits: Hits, asked: Sequence[str], chosen: FloatArray | None = None) -> FloatArray:
    """Mean of the hit rates for the words `period-1` and `chaotic`, for each row of hits (candidates, words).

    `chosen` (words,) counts how often each word is taken; once when not given.
    """
    taken = np.ones(len(asked)) if chosen is None else chosen
    rates = []
    for word in (PERIODIC, CHAOTIC):
        weight = taken * (np.array(asked) == word)
        rates.append(hits @ weight / weight.sum())
    return np.asarray(sum(rates) / len(rates))


def resampled(scores: Sequence[Score]) -> FloatArray:
    """Balanced accuracies (RESAMPLES, candidates) on words of FITTED that are drawn with replacement.

    Of each kind as many are drawn as there are. The draws are the same for all candidates and in every call.
    """
    asked, rng = np.array(words(FITTED)), np.random.default_rng(SEED)
    hits = np.array([one.fitted for one in scores])
    rows = []
    for _ in range(RESAMPLES):
        drawn = np.zeros(len(asked))
        for word in (PERIODIC, CHAOTIC):
            places = np.flatnonzero(asked == word)
            np.add.at(drawn, rng.choice(places, size=len(places)), 1)
        rows.append(balanced(hits, list(asked), drawn))
    return np.array(rows)


def interval(accuracies: FloatArray) -> tuple[float, float]:
    """The middle 95 % of resampled accuracies."""
    low, high = np.percentile(accuracies, [2.5, 97.5])
    return float(low), float(high)


def best(scores: Sequence[Score]) -> Score:
    """The candidate with the best balanced accuracy; of equals the one that shares most values with the preset."""
    return max(scores, key=lambda one: (round(one.accuracy, 9), _kept(one.candidate)))


def as_computed(scores: Sequence[Score]) -> Score:
    """The best on chords without friction and with the springs of the casing's frequencies.

    Where a thinned search has none, the best of all.
    """
    chords = [one for one in scores if one.candidate.surface == "chords"]
    plain = [one for one in chords if (one.candidate.friction, one.candidate.springs) == (0.0, 1.0)]
    return best(plain or scores)


def _kept(one: Candidate) -> int:
    return sum(a == b for a, b in zip(astuple(one), astuple(PRESET), strict=True))
