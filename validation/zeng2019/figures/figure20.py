"""Figure 20: the sweep of the casing's support at 10,000 rev/min, in two readings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from validation.piece import Found, Piece
from validation.zeng2019.drawing.sweep_figure import COLOR_NAMES, sweep_figure
from validation.zeng2019.runs.cases import casing_sweep, outcomes, readings, within
from validation.zeng2019.runs.measures import harmonics, rubbing, strongest
from validation.zeng2019.runs.outcome import Outcome
from validation.zeng2019.runs.region import CHAOTIC, PERIODIC, one_class
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import Statement, by_share, counted

if TYPE_CHECKING:
    from matplotlib.figure import Figure

REGIONS = {
    "I": ((2e2, 1.55e4), CHAOTIC, CHAOTIC),
    "II": ((1.64e4, 2.0e4), CHAOTIC, PERIODIC),
    "III": ((2.09e4, 2.63e4), PERIODIC, PERIODIC),
    "IV": ((2.72e4, 6.68e4), CHAOTIC, CHAOTIC),
    "V": ((6.77e4, 2e5), CHAOTIC, CHAOTIC),
}
"""Range in N/m, the paper's word for the blisk, and for the casing."""


def pieces(size: Size) -> Sequence[Piece]:
    """Both sweeps."""
    return [piece for reading in readings(size) for piece in casing_sweep(size, reading).values()]


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """Classes by region, orders; for each reading."""
    made: list[Statement] = []
    for reading in readings(size):
        runs = outcomes(casing_sweep(size, reading), found)
        made += [*_classes(reading, runs), *_orders(reading, runs)]
    return made


def _classes(reading: str, runs: dict[float, Outcome]) -> Sequence[Statement]:
    every = list(runs.values())
    return [
        one
        for name, (span, *words) in REGIONS.items()
        for part, word in zip(("blisk", "casing"), words, strict=True)
        for one in one_class(f"Casing support {reading}, region {name}", word, part, within(runs, *span), every)
    ]


def _orders(reading: str, runs: dict[float, Outcome]) -> Sequence[Statement]:
    rub = list(rubbing(runs).values())
    odd = sum(strongest(harmonics(run.spectrum_blisk)[:9], 2) % 2 == 1 for run in rub)
    even = sum(strongest(harmonics(run.spectrum_casing)) % 2 == 0 for run in rub)
    return [
        Statement(
            statement=f"Casing support {reading}: odd orders stand out in the blisk.",
            verdict=by_share(odd, len(rub)),
            found=f"besides f_r the strongest is odd in {counted(odd, len(rub), 'rubbing runs')}",
        ),
        Statement(
            statement=f"Casing support {reading}: even orders stand out in the casing.",
            verdict=by_share(even, len(rub)),
            found=f"strongest at the point even in {counted(even, len(rub), 'rubbing runs')}",
        ),
    ]


def figures(size: Size, found: Found) -> dict[str, Figure]:
    """One figure for each reading."""
    made = {}
    bands = {name: span for name, (span, *_) in REGIONS.items()}
    for reading, scale in readings(size).items():
        runs = {k: run for k, run in outcomes(casing_sweep(size, reading), found).items() if run.ok}
        times = f"run with {scale:g} times the number shown, " if scale != 1 else ""
        made[f"Sweep of the casing's support, {reading} ({times}{COLOR_NAMES})"] = sweep_figure(
            runs, "Casing support in the paper, N/m", bands=bands, log=True
        )
    return made


SECTION = Section(
    name="20",
    title="Figure 20: stiffness of the casing's support",
    text="The speed is 10,000 rev/min. The scan prints 1e6 N/m, which is read as 1e2 N/m (`docs/preset-zeng2019.md`). "
    "The casing of `zeng2019` has five times the mass of the lightest casing with these frequencies, and so five "
    "times its springs; that of `zeng2019-as-computed` has eight times both. So the sweep is run twice: with the "
    "printed numbers, and with the corresponding numbers for the heavier casing. Each statement says which. Runs that "
    "leave the range of a linear casing are `diverged`; the shares do not include them.",
    pieces=pieces,
    statements=statements,
    figures=figures,
    compared=True,
)
