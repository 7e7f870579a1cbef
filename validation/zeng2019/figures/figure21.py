"""Figure 21: contact at two stiffnesses of the casing's support."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from scipy.stats import spearmanr

from validation.piece import Found, Piece
from validation.zeng2019.drawing.contact_figure import contact_figure
from validation.zeng2019.figures.figure16 import RANK, zones_and_motion
from validation.zeng2019.runs.cases import NAMED_CASING_SUPPORTS, casing_sweep, on_casing_support, outcomes, readings
from validation.zeng2019.runs.measures import rubbing
from validation.zeng2019.runs.outcome import Outcome, outcome_of
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import UNKNOWABLE, Statement, power, yes_or_no

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
        *zones_and_motion([run for runs in both.values() for run in runs.values()]),
    ]


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
