"""One published statement, what was found, and the verdict; and the rules by which verdicts are given."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypedDict

AGREES, DIFFERS, UNKNOWABLE = "agrees", "differs", "unknowable"
EXPERIMENT, TIPS = "experiment", "tips"
ROUNDING, TOLERANCE = 0.005, 0.05
"""A number agrees within half a percent, agrees within what it is off by up to 5 %, and differs beyond."""
MOST, HALF = 0.9, 0.5
"""A statement about many runs agrees where nine in ten bear it out, agrees within the rest down to half of them."""


@dataclass(frozen=True, kw_only=True)
class Statement:
    """A published statement (in our words) and its verdict: `agrees`, `agrees within X`, `differs` or `unknowable`.

    `found` is what rubgen found, `why` what explains it. `used_for_fitting` marks what the preset was fitted to: its
    agreement is no evidence. `apart` marks what is no statement of the paper and stays out of the tally: EXPERIMENT, a
    hypothesis of ours about a cause, or TIPS, a statement on the blisk judged by the tips as well.
    `by_eye` is the verdict with `other_bound`, and `by_words` that with the reading `other_words`, where it is another.
    An experiment may be `about` statements: it agrees where `cause` makes them differ. `about` holds parts of them.
    """

    statement: str
    verdict: str
    found: str
    why: str = ""
    used_for_fitting: bool = False
    apart: str = ""
    by_eye: str = ""
    other_bound: str = "the scatter of 49 points"
    by_words: str = ""
    other_words: str = ""
    about: tuple[str, ...] = ()
    cause: str = ""

    def __post_init__(self) -> None:
        kinds = (AGREES, DIFFERS, UNKNOWABLE)
        if self.verdict not in kinds and not self.verdict.startswith(f"{AGREES} within "):
            raise ValueError(f"verdict {self.verdict!r}: must be one of {', '.join(kinds)} or `agrees within X`")


@dataclass(frozen=True, kw_only=True)
class Reading:
    """What else the words of a statement may mean, and the verdict by it."""

    words: str
    verdict: str


class Read(TypedDict):
    """Two fields of a Statement."""

    by_words: str
    other_words: str


def read_as(*readings: Reading) -> Read:
    """The first reading that agrees; where none does, all of them, which differ."""
    chosen = next((one for one in readings if one.verdict.startswith(AGREES)), None)
    if chosen:
        return {"by_words": chosen.verdict, "other_words": chosen.words}
    return {"by_words": DIFFERS, "other_words": "; ".join(one.words for one in readings)}


def yes_or_no(holds: bool) -> str:
    """Verdict of a statement that holds or does not."""
    return AGREES if holds else DIFFERS


def by_deviation(deviation: float, tolerance: float = TOLERANCE) -> str:
    """Verdict of a number by its relative deviation: see ROUNDING and TOLERANCE."""
    size = abs(deviation)
    if size <= ROUNDING:
        return AGREES
    return f"{AGREES} within {100 * size:.2g} %" if size <= tolerance else DIFFERS


def by_share(true: int, total: int) -> str:
    """Verdict of a statement about many runs by how many bear it out: see MOST and HALF. Of no run: unknowable."""
    if total == 0:
        return UNKNOWABLE
    share = true / total
    if share >= MOST:
        return AGREES
    return f"{AGREES} within {100 * (1 - share):.0f} % of the runs" if share >= HALF else DIFFERS


def power(value: float, digits: int = 3) -> str:
    """`1.4e8` and not `1.4e+08`."""
    mantissa, _, exponent = f"{value:.{digits}g}".partition("e")
    return f"{mantissa}e{int(exponent)}" if exponent else mantissa


def counted(true: int, total: int, what: str = "runs") -> str:
    """`17 of 20 runs (85 %)`."""
    return f"{true} of {total} {what} ({100 * true / total:.0f} %)" if total else f"no {what}"
