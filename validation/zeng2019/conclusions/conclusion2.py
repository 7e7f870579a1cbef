"""Conclusion (2): the fundamental frequency is that of rotation times the number of contact zones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from validation.piece import Found, Piece
from validation.zeng2019.drawing.contact_figure import contact_figure
from validation.zeng2019.runs.cases import case
from validation.zeng2019.runs.measures import harmonics, strongest
from validation.zeng2019.runs.outcome import Outcome, outcome_of, run_piece
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import Statement, by_share, counted

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LOBES = (2, 3, 4, 5)
SPEEDS = (9500.0, 10500.0, 11500.0, 13000.0)


def _pieces(size: Size) -> dict[tuple[int, float], Piece]:
    return {(lobes, rpm): run_piece(case(size, speed_rpm=rpm, lobes=float(lobes))) for lobes in LOBES for rpm in SPEEDS}


def pieces(size: Size) -> Sequence[Piece]:
    """Each number of lobes at each speed."""
    return list(_pieces(size).values())


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """Zones by lobes, the force's fundamental, the point's."""
    runs = {key: outcome_of(found(piece)) for key, piece in _pieces(size).items()}
    rub = {key: run for key, run in runs.items() if run.ok and run.rub}
    failed = f"; {len(runs) - len(rub)} runs diverged or did not rub" if len(rub) < len(runs) else ""
    zones = sum(run.zones == lobes for (lobes, _), run in rub.items())
    force = sum(strongest(run.force_orders) == run.zones for run in rub.values())
    regular = [run for run in rub.values() if run.regular]
    calm = sum(strongest(run.force_orders) == run.zones for run in regular)
    point = sum(strongest(harmonics(run.spectrum_casing)) == run.zones for run in rub.values())
    by_lobes = ", ".join(f"{lobes}: {_orders(rub, lobes)}" for lobes in LOBES)
    return [
        Statement(
            statement="A casing of N lobes has N contact zones.",
            verdict=by_share(zones, len(rub)),
            found=counted(zones, len(rub), "runs with 2, 3, 4, 5 lobes") + failed,
        ),
        Statement(
            statement="The fundamental frequency of the contact load is f_r times the number of zones.",
            verdict=by_share(force, len(rub)),
            found=f"strongest order equals the zones in {counted(force, len(rub))}, of the period-1 runs in "
            f"{counted(calm, len(regular))}; strongest orders by number of lobes {by_lobes}",
        ),
        Statement(
            statement="The fundamental frequency of the casing's vibration is f_r times the number of zones.",
            verdict=by_share(point, len(rub)),
            found=f"at the point of the minor axis {counted(point, len(rub))}; strongest orders by number of lobes "
            + ", ".join(f"{lobes}: {_orders(rub, lobes, at_point=True)}" for lobes in LOBES),
            why="A point moves with shapes of all orders, whatever the fundamental of the load. Near the ring's own "
            "181 Hz, which is f_r at 10,860 rev/min, it shows f_r: with three lobes f_r, not 3 f_r.",
        ),
    ]


def _orders(runs: dict[tuple[int, float], Outcome], lobes: int, *, at_point: bool = False) -> str:
    """Strongest order of the contact force, or of the point at the minor axis, at each speed."""
    chosen = [run for (n, _), run in runs.items() if n == lobes]
    every = [harmonics(run.spectrum_casing) if at_point else run.force_orders for run in chosen]
    return " ".join(str(strongest(amplitudes)) for amplitudes in every) or "none"


def figures(size: Size, found: Found) -> dict[str, Figure]:
    """Contact with each number of lobes at one speed."""
    runs = {key: outcome_of(found(piece)) for key, piece in _pieces(size).items()}
    shown = {f"{lobes} lobes": runs[lobes, SPEEDS[1]] for lobes in LOBES if runs[lobes, SPEEDS[1]].ok}
    return {f"Contact with 2 to 5 lobes at {SPEEDS[1]:,.0f} rev/min": contact_figure(shown)} if shown else {}


SECTION = Section(
    name="c2",
    title="Conclusion (2): fundamental frequency and zones",
    text="The paper's two lobes are compared with three, four and five. Figures 16, 18 and 21 count how often period-1"
    " motion has equal and symmetric zones.",
    pieces=pieces,
    statements=statements,
    figures=figures,
    compared=True,
)
