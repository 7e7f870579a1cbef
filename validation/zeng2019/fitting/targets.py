"""The paper's words for the motion at some speeds and supports: those that the search uses, and those held out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from validation.zeng2019.runs.cases import SUPPORT_RPM
from validation.zeng2019.runs.region import CHAOTIC, PERIODIC

ANY = "any"


@dataclass(frozen=True, kw_only=True)
class Target:
    """A run and the paper's words for the motion of blisk and casing; stiffnesses of the casing as printed."""

    speed_rpm: float = SUPPORT_RPM
    disk_support: float | None = None
    casing_support: float | None = None
    blisk: str
    casing: str


FITTED = (
    *(Target(speed_rpm=rpm, blisk=PERIODIC, casing=CHAOTIC) for rpm in (6900.0, 7260.0, 7620.0, 7980.0)),
    *(Target(speed_rpm=rpm, blisk=CHAOTIC, casing=ANY) for rpm in (8130.0, 8340.0)),
    *(Target(speed_rpm=rpm, blisk=PERIODIC, casing=ANY) for rpm in (8640.0, 8880.0)),
    *(Target(speed_rpm=rpm, blisk=CHAOTIC, casing=CHAOTIC) for rpm in (11400.0, 12300.0, 13200.0, 14100.0, 14910.0)),
)
"""Classes of the regions II, III and V: what the search uses."""
PREDICTED = (
    *(Target(disk_support=k, blisk=PERIODIC, casing=PERIODIC) for k in (1.4e8, 2e8, 3e8, 6e8)),
    Target(casing_support=3.8e3, blisk=CHAOTIC, casing=CHAOTIC),
    Target(casing_support=1.82e4, blisk=CHAOTIC, casing=PERIODIC),
    Target(casing_support=2.27e4, blisk=PERIODIC, casing=PERIODIC),
    Target(casing_support=5.06e4, blisk=CHAOTIC, casing=CHAOTIC),
    Target(casing_support=1.25e5, blisk=CHAOTIC, casing=CHAOTIC),
)
"""Classes of the sweeps of both supports: held out."""
TARGETS = FITTED + PREDICTED


def words(targets: Sequence[Target]) -> list[str]:
    """The paper's words in the targets: for each run that of the blisk, then that of the casing, where it has one."""
    return [word for target in targets for word in (target.blisk, target.casing) if word != ANY]
