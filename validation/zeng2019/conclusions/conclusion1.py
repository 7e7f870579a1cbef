"""Conclusion (1): only a few modes are needed, tested by what more of them change in labels and spectra."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rubgen.scenario import Reduction
from validation.piece import Found, Piece
from validation.zeng2019.runs.cases import case
from validation.zeng2019.runs.measures import harmonics
from validation.zeng2019.runs.outcome import Outcome, outcome_of, run_piece
from validation.zeng2019.section import Section, no_figures
from validation.zeng2019.size import Size
from validation.zeng2019.statement import Statement, by_share, counted

SPEEDS = (7500.0, 8500.0, 9500.0, 10500.0, 11500.0, 13000.0)
FEW = Reduction()
MORE = {
    "8 modes a blade": replace(FEW, blade_modes=8),
    "10 modes of the disk": replace(FEW, disk_modes=10),
    "40 modes of the blisk": replace(FEW, blisk_modes=40),
}
CASING = replace(FEW, casing_modes=15)


def _piece(size: Size, rpm: float, reduction: Reduction) -> Piece:
    return run_piece(replace(case(size, speed_rpm=rpm), reduction=reduction))


def pieces(size: Size) -> Sequence[Piece]:
    """Six speeds with each set of modes."""
    return [_piece(size, rpm, modes) for modes in (FEW, *MORE.values(), CASING) for rpm in SPEEDS]


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """Labels, orders; and the casing's modes apart."""

    def runs(modes: Reduction) -> list[Outcome]:
        return [outcome_of(found(_piece(size, rpm, modes))) for rpm in SPEEDS]

    few = runs(FEW)
    pairs = [(one, other) for modes in MORE.values() for one, other in zip(few, runs(modes), strict=True)]
    casing = list(zip(few, runs(CASING), strict=True))
    return [
        _equal("More modes of blade, disk and blisk do not change the class of motion.", pairs),
        _orders(pairs),
        _equal("Four more casing modes (15 instead of 11) do not change the class of motion.", casing, CASING_WHY),
    ]


CASING_WHY = (
    "Tips pass at 419 m/s, waves of the ring travel at 66 to 153 m/s: contact excites each additional wave. The "
    "number of casing modes belongs to the machine's definition."
)


def _equal(statement: str, pairs: list[tuple[Outcome, Outcome]], why: str = "") -> Statement:
    equal = sum(one.label == other.label for one, other in pairs)
    others = ", ".join(sorted({f"{one.label} to {other.label}" for one, other in pairs if one.label != other.label}))
    found = counted(equal, len(pairs), "pairs of runs") + (f"; else {others}" if others else "")
    return Statement(statement=statement, verdict=by_share(equal, len(pairs)), found=found, why=why)


def _orders(pairs: list[tuple[Outcome, Outcome]]) -> Statement:
    """Orders 1 and 3 of the blisk and 2 of the force where both runs are period-1."""
    regular = [(one, other) for one, other in pairs if one.regular and other.regular]
    changes = np.array([_changes(one, other) for one, other in regular]).reshape(-1, 3)
    small = int(np.sum(np.all(np.abs(changes[:, [0, 2]]) < 0.05, axis=1)))
    worst = np.abs(changes).max(axis=0) if len(changes) else np.zeros(3)
    return Statement(
        statement="More such modes change f_r of the blisk and 2 f_r of the force in regular motion by at most 5 %.",
        verdict=by_share(small, len(regular)),
        found=f"{counted(small, len(regular), 'period-1 pairs')}; largest changes: f_r {100 * worst[0]:.2f} %, 3 f_r "
        f"{100 * worst[1]:.0f} %, 2 f_r of the force {100 * worst[2]:.2f} %",
        why="3 f_r of the disk centre needs 40 modes of the blisk (`docs/sensitivity.md`).",
    )


def _changes(one: Outcome, other: Outcome) -> tuple[float, float, float]:
    here, there = harmonics(one.spectrum_blisk), harmonics(other.spectrum_blisk)
    force = one.force_orders[1] / other.force_orders[1] if other.force_orders[1] else 1.0
    return float(here[0] / there[0] - 1), float(here[2] / max(there[2], 1e-15) - 1), float(force - 1)


SECTION = Section(
    name="c1",
    title="Conclusion (1): few modes suffice",
    text="The same six speeds are run with the paper's modes (4, 4, 4 and 11 of the casing) and with more modes.",
    pieces=pieces,
    statements=statements,
    figures=no_figures,
)
