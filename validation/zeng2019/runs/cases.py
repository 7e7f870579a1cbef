"""The runs: what is swept, by which steps, and the scenario of each value."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from rubgen.scenario import Scenario
from rubgen.scenario.vary import vary
from validation.piece import Found, Piece
from validation.zeng2019.runs.outcome import Outcome, outcome_of, run_piece
from validation.zeng2019.size import Size

REGIONS = {"I": (2460, 6660), "II": (6780, 7980), "III": (8100, 8910), "IV": (8940, 11100), "V": (11220, 14940)}
"""The paper's ranges of speed, rev/min."""
SPEEDS = tuple(float(rpm) for rpm in (*range(2460, 6780, 120), *range(6780, 14941, 30)))
"""Rev/min: by 120 where nothing rubs, by 30 as in the paper's close-ups beyond."""
ONSET_RPM = (6660.0, 6780.0)
"""Rev/min: the last speed without rub and the first with it."""
NAMED_SPEEDS = (7980.0, 8280.0, 8820.0, 9750.0, 10710.0, 11400.0)
SUPPORT_RPM = 10000.0


def _range(low: float, high: float, step: float) -> list[float]:
    return [float(value) for value in np.arange(low, high + step / 2, step)]


DISK_SUPPORTS = tuple(
    1e6 * k
    for k in (
        *_range(80, 120, 10),
        *_range(125, 160, 5),
        *_range(180, 340, 20),
        *_range(360, 560, 10),
        *_range(580, 660, 20),
        670, 675, 680, 700, 750,
    )
)  # fmt: skip
"""N/m, closer where the paper has its trip point (1.4e8) and its alternating region (3.70e8 to 5.45e8)."""
NAMED_DISK_SUPPORTS, END_OF_RUB = (1.4e8, 4.55e8), (6.7e8, 6.75e8)
"""N/m: those of figure 18, and the last with rub and the first without."""
CASING_SUPPORTS = tuple(
    1e2 * k
    for k in (
        2, 20, 38, 56, 74, 92, 110, 128, 146, 155,
        *_range(164, 200, 9),
        *_range(209, 263, 9),
        272, 290, 326, 362, 398, 434, 470, 506, 560, 614, 668,
        677, 800, 950, 1100, 1250, 1400, 1550, 1700, 1850, 2000,
    )
)  # fmt: skip
"""N/m a node, on the paper's own grid, closer where its regions are narrow."""
NAMED_CASING_SUPPORTS = (3.8e3, 2.27e4)
LIGHTEST_WIDTH_M = 0.053324
"""Width of the lightest reading of the casing, 1.39 kg, on springs of 1e4 N/m at each node."""
PRINTED, SCALED = "as printed", "in proportion to the mass"


def case(size: Size, friction: float = 0.0, **values: float) -> Scenario:
    """The machine with its contact law and these keys of `[vary]`, with the turns of that size."""
    scenario = vary(size.scenario(), values)
    return replace(scenario, contact=replace(scenario.contact, friction=friction))


@cache
def at_speed(size: Size, rpm: float, friction: float = 0.0) -> Piece:
    """A run of the speed sweep."""
    return run_piece(case(size, friction, speed_rpm=rpm))


@cache
def on_disk_support(size: Size, stiffness: float) -> Piece:
    """A run of the sweep of the disk's support at 10,000 rev/min."""
    return run_piece(case(size, speed_rpm=SUPPORT_RPM, disk_support_stiffness_n_per_m=stiffness))


def readings(size: Size) -> dict[str, float]:
    """Factors of the two readings of the paper's casing supports: as printed, and times what the casing is heavier.

    The casing's frequencies fix the ratio of springs to mass: five times the lightest mass has five times its springs.
    """
    return {PRINTED: 1.0, SCALED: round(size.scenario().machine.casing.width_m / LIGHTEST_WIDTH_M, 2)}


@cache
def on_casing_support(size: Size, printed: float, reading: str) -> Piece:
    """A run of the sweep of the casing's support at 10,000 rev/min; `printed` is the paper's number."""
    stiffness = readings(size)[reading] * printed
    return run_piece(case(size, speed_rpm=SUPPORT_RPM, casing_support_stiffness_n_per_m=stiffness))


def speed_sweep(size: Size) -> dict[float, Piece]:
    """All runs of the speed sweep by rev/min."""
    return {rpm: at_speed(size, rpm) for rpm in swept_speeds(size)}


def swept_speeds(size: Size) -> tuple[float, ...]:
    """The speeds of the sweep at this size, those named in the paper, and both ends of region I.

    Rub begins between the last speed of region I and the next.
    """
    free = [rpm for rpm in SPEEDS if rpm <= REGIONS["I"][1]]
    return (*size.of(free), *sorted({*size.speeds_of(SPEEDS[len(free) :]), *NAMED_SPEEDS}))


def disk_sweep(size: Size) -> dict[float, Piece]:
    """All runs of the sweep of the disk's support by its stiffness, those named in the paper among them."""
    swept = {*size.of(DISK_SUPPORTS), *NAMED_DISK_SUPPORTS, *END_OF_RUB}
    return {k: on_disk_support(size, k) for k in sorted(swept)}


def casing_sweep(size: Size, reading: str) -> dict[float, Piece]:
    """All runs of the sweep of the casing's support by its printed stiffness, those named in the paper among them."""
    swept = {*size.of(CASING_SUPPORTS), *NAMED_CASING_SUPPORTS}
    return {k: on_casing_support(size, k, reading) for k in sorted(swept)}


def outcomes(pieces: dict[float, Piece], found: Found) -> dict[float, Outcome]:
    """The outcomes of a sweep."""
    return {value: outcome_of(found(piece)) for value, piece in pieces.items()}


def within(runs: dict[float, Outcome], low: float, high: float) -> dict[float, Outcome]:
    """The runs whose value lies in the range, ends included."""
    return {value: run for value, run in runs.items() if low - 1e-9 <= value <= high * (1 + 1e-12)}
