"""Figure 16: contact on casing and blades at six speeds, and what contact and motion have to do with each other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from scipy.stats import spearmanr

from rubgen.arrays import FloatArray
from validation.piece import Found, Piece
from validation.zeng2019.drawing.contact_figure import contact_figure
from validation.zeng2019.meanings import WORDS
from validation.zeng2019.runs.cases import NAMED_SPEEDS, at_speed, case, outcomes, speed_sweep
from validation.zeng2019.runs.measures import PROMINENT, harmonics, motion_of, rubbing, strongest
from validation.zeng2019.runs.outcome import Outcome, outcome_of, run_piece
from validation.zeng2019.runs.region import SEEN, with_tips
from validation.zeng2019.section import Section
from validation.zeng2019.size import TWIN, Size
from validation.zeng2019.statement import EXPERIMENT, Statement, by_share, counted, yes_or_no

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NEAR_DEG = 30.0
BROKEN = "Period-1 with broken symmetry exists and is legitimate."
BY_TURN = "Zones are called symmetric by the impulse of each turn."
RANK = 0.5
"""Least rank correlation that is called a dependence."""


LESS_AIR = tuple(1e-6 * um for um in (0, 20, 40, 60, 80))
"""By how much the clearance is made smaller in the experiment on area and blades, in m."""
CLOSED_RPM = 10601.0
"""Rev/min from which the tips grow as far as the clearance without any whirl: `docs/preset-zeng2019.md`."""


def pieces(size: Size) -> Sequence[Piece]:
    """The sweep, the six named speeds, and these with less air; the twin has no experiment."""
    tight = [piece for runs in tighter(size).values() for piece in runs] if size.machine != TWIN else []
    return [*speed_sweep(size).values(), *(at_speed(size, rpm) for rpm in NAMED_SPEEDS), *tight]


def tighter(size: Size) -> dict[float, list[Piece]]:
    """Runs with LESS_AIR at the named speeds."""
    own = size.scenario().machine.casing.clearance_m
    return {
        rpm: [
            run_piece(case(size, speed_rpm=rpm, clearance_m=own - less)) if less else at_speed(size, rpm)
            for less in LESS_AIR
        ]
        for rpm in NAMED_SPEEDS
    }


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """Zones, harmonics of contact, area and blades, symmetry and motion."""
    runs = rubbing(outcomes(speed_sweep(size), found))
    rub, named = list(runs.values()), [runs[rpm] for rpm in NAMED_SPEEDS if rpm in runs]
    made = [*_places(rub), *_impacts(rub), *_blades(rub, named), *zones_and_motion(rub)]
    return made if size.machine == TWIN else [*made, _heavier(size, found)]


def _heavier(size: Size, found: Found) -> Statement:
    """Area and blades at one speed, as the rub gets heavier: an experiment on why they part over the speed."""
    ranks, told = dict[float, float](), list[str]()
    for rpm, pieces_ in tighter(size).items():
        runs = [run for run in (outcome_of(found(piece)) for piece in pieces_) if run.ok and run.rub]
        ranks[rpm], area, blades = _area_and_blades(runs)
        told.append(
            f"{rpm:,.0f} rev/min {area[0]:.0f} to {area[-1]:.0f} degrees and {blades[0]} to {blades[-1]} blades"
        )
    whirl = [rank for rpm, rank in ranks.items() if rpm < CLOSED_RPM]
    true = sum(rank >= RANK for rank in whirl)
    values = ", ".join(
        f"{rpm:,.0f}: {rank:.2f}".replace("nan", "one of them does not change") for rpm, rank in ranks.items()
    )
    return Statement(
        statement="At one speed, where the tips reach the casing by whirl, heavier rub has both a larger contact area "
        "and more blades.",
        verdict=by_share(true, len(whirl)),
        found=f"with up to {1e6 * LESS_AIR[-1]:.0f} um less air the rank correlation is at least {RANK:g} at "
        f"{counted(true, len(whirl), 'speeds')} below {CLOSED_RPM:,.0f} rev/min ({values}); {'; '.join(told)}",
        why=f"From {CLOSED_RPM:,.0f} rev/min on growth alone closes the clearance: all blades touch, on a narrow arc. "
        "So area and blades part over the speed.",
        apart=EXPERIMENT,
        about=("The larger the contact area",),
        cause=WORDS,
    )


def _places(rub: list[Outcome]) -> Sequence[Statement]:
    two = sum(run.zones == 2 for run in rub)
    near = sum(bool(run.zones) and float(_from_minor_axis(run).max()) <= NEAR_DEG for run in rub)
    return [
        Statement(
            statement="Contact lies around the semi-minor axis of the oval.",
            verdict=by_share(near, len(rub)),
            found=f"all zones centred within {NEAR_DEG:.0f} degrees of it in {counted(near, len(rub), 'rubbing runs')}",
        ),
        Statement(
            statement="There are two contact zones on the casing.",
            verdict=by_share(two, len(rub)),
            found=counted(two, len(rub), "rubbing runs"),
        ),
    ]


def _impacts(rub: list[Outcome]) -> Sequence[Statement]:
    double = sum(strongest(run.force_orders) == 2 for run in rub)
    many = sum(_shown(run, PROMINENT) for run in rub)
    return [
        Statement(
            statement="Each turn brings two impacts: the contact load has the fundamental 2 f_r.",
            verdict=by_share(double, len(rub)),
            found=f"2 f_r is the strongest order of the contact force in {counted(double, len(rub), 'rubbing runs')}",
        ),
        Statement(
            statement="The casing shows 4 f_r, 6 f_r and 8 f_r as well.",
            verdict=by_share(many, len(rub)),
            by_eye=by_share(sum(_shown(run, PROMINENT / 10) for run in rub), len(rub)),
            other_bound=f"{10 * PROMINENT:g} % of the strongest line as the bound of what is visible",
            found=f"all three above {100 * PROMINENT:.0f} % of the strongest in "
            + counted(many, len(rub), "rubbing runs"),
        ),
    ]


def _area_and_blades(runs: list[Outcome]) -> tuple[float, FloatArray, FloatArray]:
    """Rank correlation of touched arc and blades that touch, and both; NaN where one of them is the same in all."""
    area, blades = np.array([r.area_deg for r in runs]), np.array([np.count_nonzero(r.on_blades) for r in runs])
    varied = len(runs) > 1 and np.ptp(blades) and np.ptp(area)
    return float(spearmanr(area, blades).statistic) if varied else float("nan"), area, blades


def _blades(rub: list[Outcome], named: list[Outcome]) -> Sequence[Statement]:
    (rank, area, blades), (of_named, _, _) = _area_and_blades(rub), _area_and_blades(named)
    several = sum(run.at_once >= 2 for run in rub)
    beside = sum(run.neighbours > 0 for run in rub)
    return [
        Statement(
            statement="The larger the contact area, the more blades take part.",
            verdict=yes_or_no(rank >= RANK),
            by_words=yes_or_no(of_named >= RANK),
            other_words=f"at the six speeds that the paper draws (rank correlation {of_named:.2f})",
            found=f"rank correlation of touched arc and blades that touch {rank:.2f} over {len(rub)} rubbing runs "
            f"(arc {area.min():.0f} to {area.max():.0f} degrees, {blades.min()} to {blades.max()} blades)",
        ),
        Statement(
            statement="Several blades touch at the same time.",
            verdict=by_share(several, len(rub)),
            found=counted(several, len(rub), "rubbing runs"),
        ),
        Statement(
            statement="The neighbour of a rubbing blade may touch at the same time.",
            verdict=yes_or_no(beside >= SEEN * len(rub)),
            found=f"at some time in {counted(beside, len(rub), 'rubbing runs')}",
            why="In the other runs, blades that touch at the same time are not neighbours.",
        ),
    ]


def zones_and_motion(rub: Sequence[Outcome]) -> Sequence[Statement]:
    """Whether period-1 goes with equal, symmetric zones, and chaos with unequal ones: at the centre, and with tips."""

    def equal(part: str) -> tuple[str, str]:
        regular = [run for run in rub if motion_of(run, part) == "period-1"]
        true = sum(run.symmetric == 1 for run in regular)
        return by_share(true, len(regular)), f"symmetric in {counted(true, len(regular), 'period-1 runs')}"

    def unequal(part: str) -> tuple[str, str]:
        chaotic = [run for run in rub if motion_of(run, part) == "chaotic"]
        true = sum(run.symmetric == 0 for run in chaotic)
        uneven = f"{100 * float(np.median([unevenness(run) for run in chaotic])):.1f} %" if chaotic else "nothing"
        return by_share(true, len(chaotic)), (
            f"not symmetric in {counted(true, len(chaotic), 'chaotic runs')}; summed over 49 turns, as the paper draws "
            f"them, the two halves of the casing differ by {uneven} of the whole (median of these runs)"
        )

    made: list[Statement] = []
    for word, judged, why in (
        ("Period-1 motion of the blisk goes with equal and symmetric", equal, BROKEN),
        ("Chaotic motion of the blisk goes with unequal", unequal, BY_TURN),
    ):
        verdict, found = judged("blisk")
        first = Statement(statement=f"{word} contact zones.", verdict=verdict, found=found, why=why)
        made += with_tips("blisk", first, judged)
    return made


def unevenness(run: Outcome) -> float:
    """Difference of the impulses of the last 49 turns on the halves right and left of the centre, over their sum."""
    quarter = len(run.on_casing) // 4
    right = float(run.on_casing[:quarter].sum() + run.on_casing[-quarter:].sum())
    whole = float(run.on_casing.sum())
    return abs(2 * right - whole) / whole if whole > 0 else 0.0


def _from_minor_axis(run: Outcome) -> np.ndarray:
    return np.asarray(np.abs((run.centres_deg + 90) % 180 - 90))


def _shown(run: Outcome, share: float) -> bool:
    """Whether the orders 4, 6 and 8 at the point reach this share of its strongest line."""
    return bool(np.all(harmonics(run.spectrum_casing)[[3, 5, 7]] >= share * float(run.spectrum_casing.max())))


def figures(size: Size, found: Found) -> dict[str, Figure]:
    """The six named speeds."""
    named = outcomes({rpm: at_speed(size, rpm) for rpm in NAMED_SPEEDS}, found)
    caption = "Impulse of the last 49 turns by place on the casing (blue) and by blade (red), each over its largest"
    return {caption: contact_figure({f"{rpm:,.0f} rev/min": run for rpm, run in named.items()})}


SECTION = Section(
    name="16",
    title="Figure 16: where the casing is touched",
    text="Statements are judged over every rubbing run of the speed sweep. The picture shows the paper's six speeds. "
    "The last row is an experiment on area and blades: at each of them the rub is made heavier by less air.",
    pieces=pieces,
    statements=statements,
    figures=figures,
    compared=True,
)
