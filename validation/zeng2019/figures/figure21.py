"""Figure 21: contact at two stiffnesses of the casing's support."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from scipy.stats import spearmanr

from validation.piece import Found, Piece
from validation.zeng2019.drawing.contact_figure import contact_figure
from validation.zeng2019.figures.figure16 import RANK, zones_and_motion
from validation.zeng2019.meanings import DIMENSION
from validation.zeng2019.runs.cases import (
    NAMED_CASING_SUPPORTS,
    PRINTED,
    SCALED,
    casing_sweep,
    on_casing_support,
    outcomes,
    readings,
)
from validation.zeng2019.runs.measures import rubbing
from validation.zeng2019.runs.outcome import Outcome, outcome_of
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import EXPERIMENT, UNKNOWABLE, Statement, power, yes_or_no

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _named(size: Size) -> dict[str, Piece]:
    return {
        f"{power(k)} N/m\n{reading}": on_casing_support(size, k, reading)
        for reading in readings(size)
        for k in NAMED_CASING_SUPPORTS
    }


def pieces(size: Size) -> Sequence[Piece]:
    """Both sweeps and the named values."""
    sweeps = [piece for reading in readings(size) for piece in casing_sweep(size, reading).values()]
    return [*sweeps, *_named(size).values()]


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """Area over stiffness, zones and motion."""
    both = {reading: rubbing(outcomes(casing_sweep(size, reading), found)) for reading in readings(size)}
    return [
        *(_area(reading, runs) for reading, runs in both.items()),
        _softer(size, both[PRINTED]),
        *zones_and_motion([run for runs in both.values() for run in runs.values()]),
    ]


def _softer(size: Size, runs: dict[float, Outcome]) -> Statement:
    """The printed numbers on the heavier casing, on the two supports that the paper draws."""
    area = {k: float(runs[k].area_deg) for k in NAMED_CASING_SUPPORTS if k in runs}
    told = " and ".join(f"{value:.1f} degrees at {power(k)} N/m" for k, value in area.items())
    soft, stiff = (area.get(k, float("nan")) for k in NAMED_CASING_SUPPORTS)
    return Statement(
        statement="Each kg of the casing on a softer support than in that proportion: of the two that the paper draws, "
        "the softer has the larger contact area.",
        verdict=UNKNOWABLE if np.isnan(soft + stiff) else yes_or_no(soft > stiff),
        found=f"{readings(size)[SCALED]:g} times softer, that is as printed: {told}",
        why="The paper does not name the support on which the casing has its frequencies, and the unit of the sweep is "
        "lost: so is the support of each kg.",
        apart=EXPERIMENT,
        about=(f"Casing support {SCALED}: the softer",),
        cause=DIMENSION,
    )


def _area(reading: str, runs: dict[float, Outcome]) -> Statement:
    area = np.array([run.area_deg for run in runs.values()])
    rank = float(spearmanr(list(runs), area).statistic) if len(runs) > 2 and np.ptp(area) else float("nan")
    soft, stiff = (f"{area[i]:.0f} degrees at {power(list(runs)[i])} N/m" for i in (0, -1))
    named = [float(runs[k].area_deg) for k in NAMED_CASING_SUPPORTS if k in runs]
    told = " and ".join(f"{value:.0f}" for value in named)
    return Statement(
        by_words=yes_or_no(len(named) == len(NAMED_CASING_SUPPORTS) and named[0] > named[1]),
        other_words=f"on the two supports that the paper draws ({told} degrees)",
        statement=f"Casing support {reading}: the softer it is, the larger the contact area.",
        verdict=UNKNOWABLE if np.isnan(rank) else yes_or_no(rank <= -RANK),
        found=f"rank correlation of stiffness and touched arc {rank:.2f} over {len(runs)} runs that rub and do not "
        f"diverge ({soft}, {stiff})",
    )


def figures(size: Size, found: Found) -> dict[str, Figure]:
    """The named values in both readings, as far as they did not diverge."""
    named = {name: outcome_of(found(piece)) for name, piece in _named(size).items()}
    good = {name: run for name, run in named.items() if run.ok}
    caption = "Impulse of the last 49 turns by place (blue) and by blade (red), on casing supports named in the paper"
    return {caption: contact_figure(good)} if good else {}


SECTION = Section(
    name="21",
    title="Figure 21: contact on two casing supports",
    text="Statements are judged over every rubbing run of both sweeps of the casing's support.",
    pieces=pieces,
    statements=statements,
    figures=figures,
    compared=True,
)
