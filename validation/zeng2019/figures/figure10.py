"""Figure 10: the speed sweep."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from validation.piece import Found, Piece
from validation.zeng2019.drawing.sweep_figure import COLOR_NAMES, sweep_figure
from validation.zeng2019.runs.cases import ONSET_RPM, REGIONS, outcomes, speed_sweep, within
from validation.zeng2019.runs.measures import (
    PROMINENT,
    fractional,
    harmonics,
    motion_of,
    rubbing,
    segments,
    strongest,
)
from validation.zeng2019.runs.outcome import Outcome
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import Statement, by_share, counted, yes_or_no

if TYPE_CHECKING:
    from matplotlib.figure import Figure

EDGE_RPM = 120.0
STRETCH = 5
"""Fewer runs of one class in a row are no region."""
SILENT = 1e-6
"""Share of the unbalance's own line below which an order is not there."""


def pieces(size: Size) -> Sequence[Piece]:
    """The whole sweep."""
    return list(speed_sweep(size).values())


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """Onset, region I, regions, orders, fractional frequencies."""
    runs = outcomes(speed_sweep(size), found)
    return [_onset(runs), *_region_one(runs), _regions(runs), *_orders(runs), *_fractional(runs), _degree(runs)]


def _onset(runs: dict[float, Outcome]) -> Statement:
    first = min(rubbing(runs))
    before = max(value for value in runs if value < first)
    return Statement(
        statement="Rub begins between 6,660 and 6,780 rev/min.",
        verdict=yes_or_no(ONSET_RPM[0] <= before and first <= ONSET_RPM[1]),
        found=f"no contact at {before:,.0f}, contact at {first:,.0f} rev/min",
        why="Unbalance and clearance were fitted to it.",
        used_for_fitting=True,
    )


def _region_one(runs: dict[float, Outcome]) -> Sequence[Statement]:
    free = [run for run in within(runs, *REGIONS["I"]).values() if run.ok]
    alone = [_only_first(run) and run.motion_centre == "period-1" for run in free]
    return [
        Statement(
            statement="Region I: the blisk is in period-1 motion and shows f_r alone.",
            verdict=by_share(sum(alone), len(free)),
            found=f"so do {counted(sum(alone), len(free))}, and no other order is above {SILENT:g} of f_r",
        ),
        Statement(
            statement="Region I: the casing stands still.",
            verdict=by_share(sum(run.motion_casing == "static" for run in free), len(free)),
            found=counted(sum(run.motion_casing == "static" for run in free), len(free)),
        ),
    ]


def _only_first(run: Outcome) -> bool:
    lines = harmonics(run.spectrum_blisk)
    return bool(lines[1:].max() <= SILENT * lines[0])


def _regions(runs: dict[float, Outcome]) -> Statement:
    good = {value: run for value, run in runs.items() if run.ok}
    names = [motion_of(run, "casing") for run in good.values()]
    found = segments(list(good), names, STRETCH)
    edges = [(a[2] + b[1]) / 2 for a, b in pairwise(found)]
    asked = [(REGIONS[a][1] + REGIONS[b][0]) / 2 for a, b in pairwise(list(REGIONS)[1:])]
    met = [bool(edges) and min(abs(edge - one) for edge in edges) <= EDGE_RPM for one in asked]
    stretches = "; ".join(f"{name} {first:,.0f} to {last:,.0f}" for name, first, last in found)
    return Statement(
        statement="Beyond the onset the regions II to V are separated near 8,040, 8,925 and 11,160 rev/min.",
        verdict=by_share(sum(met), len(asked)),
        found=f"{sum(met)} of these {len(asked)} edges lie within {EDGE_RPM:.0f} rev/min of one of ours, where the "
        f"class of at least {STRETCH} runs in a row changes; the casing: {stretches}",
    )


def _orders(runs: dict[float, Outcome]) -> Sequence[Statement]:
    rub = list(rubbing(runs).values())
    blisk = [strongest(harmonics(run.spectrum_blisk)[:9], 2) % 2 == 1 for run in rub]
    point = [strongest(harmonics(run.spectrum_casing)) % 2 == 0 for run in rub]
    even = [strongest(run.force_orders) % 2 == 0 for run in rub]
    shapes = [strongest(run.even_field) % 2 == 0 and strongest(run.odd_field) % 2 == 1 for run in rub]
    return [
        Statement(
            statement="Odd orders, f_r, 3 f_r, 5 f_r, stand out in the blisk.",
            verdict=by_share(sum(blisk), len(rub)),
            found=f"besides f_r the strongest order is odd in {counted(sum(blisk), len(rub), 'rubbing runs')}",
        ),
        Statement(
            statement="Even orders, 2 f_r, 4 f_r, 6 f_r, stand out in the casing.",
            verdict=by_share(sum(point), len(rub)),
            found=f"at the point the strongest order is even in {counted(sum(point), len(rub), 'rubbing runs')}, of "
            f"the contact force in {counted(sum(even), len(rub), 'runs')}",
            why="By symmetry the force and even circumferential shapes have even orders, and odd shapes have odd "
            f"orders (true of {counted(sum(shapes), len(rub), 'runs')}). A point shows both. See `causes`.",
        ),
    ]


def _fractional(runs: dict[float, Outcome]) -> Sequence[Statement]:
    high = [run for run in within(runs, *REGIONS["V"]).values() if run.ok]
    low = list(rubbing(within(runs, 6780.0, 11100.0)).values())
    made = []
    for part in ("blisk", "casing"):
        shown, below = (
            sum(fractional(getattr(run, f"spectrum_{part}")) >= PROMINENT for run in some) for some in (high, low)
        )
        first = Statement(
            statement=f"Region V: fractional frequencies appear in the {part}.",
            verdict=by_share(shown, len(high)),
            found=f"lines off whole orders above {100 * PROMINENT:.0f} % of the strongest in "
            f"{counted(shown, len(high))}; in the regions II to IV in {counted(below, len(low))}",
        )
        made.append(_besides_first(first, high) if part == "blisk" else first)
    return made


def _besides_first(one: Statement, high: Sequence[Outcome]) -> Statement:
    """The verdict by the lines besides f_r, which is the unbalance's own and hundreds of times any other."""
    orders = [float(harmonics(run.spectrum_blisk)[1:].max() / run.spectrum_blisk.max()) for run in high]
    shown = sum(fractional(run.spectrum_blisk, 2) >= PROMINENT for run in high)
    return replace(
        one,
        by_eye=by_share(shown, len(high)),
        other_bound=f"{100 * PROMINENT:.0f} % of the strongest order besides f_r, since the paper sees 3 f_r and 5 f_r "
        f"(here the strongest is {np.median(orders):.1g} of f_r, median) as the bound ({counted(shown, len(high))})",
    )


def _degree(runs: dict[float, Outcome]) -> Statement:
    mean = {
        name: float(np.mean([run.impulse for run in within(runs, *span).values() if run.ok]))
        for name, span in REGIONS.items()
    }
    return Statement(
        statement="Rubbing is heavier near the critical speed (III) and at high speed (V) than between (II, IV).",
        verdict=yes_or_no(min(mean["III"], mean["V"]) > max(mean["II"], mean["IV"])),
        by_words=yes_or_no(mean["III"] > mean["II"] and mean["V"] > mean["IV"]),
        other_words="heavier than in the region just below",
        found="mean impulse a turn " + ", ".join(f"{name}: {mean[name]:.3f}" for name in list(REGIONS)[1:]) + " N s",
    )


def figures(size: Size, found: Found) -> dict[str, Figure]:
    """The sweep as the paper shows it."""
    runs = outcomes(speed_sweep(size), found)
    bands = {name: (float(low), float(high)) for name, (low, high) in REGIONS.items()}
    return {f"Speed sweep: 49 points a run and orders ({COLOR_NAMES})": sweep_figure(
        runs, "Speed, rev/min", bands=bands)}  # fmt: skip


SECTION = Section(
    name="10",
    title="Figure 10: speed sweep",
    text="The speeds are 2,460 to 14,940 rev/min, in steps of 120 without rub and of 30 with rub. The figure shows x "
    "of the disk centre and the acceleration of the casing at the minor axis: 49 points, once a turn, and spectra"
    " of 100 turns.",
    pieces=pieces,
    statements=statements,
    figures=figures,
    compared=True,
)
