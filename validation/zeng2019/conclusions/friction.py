"""Frictionless against frictional: the paper's coefficient is lost."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rubgen.viz.colors import BLUE, GREEN, ORANGE, VERMILION
from validation.piece import Found, Piece
from validation.zeng2019.drawing.style import new_figure, style
from validation.zeng2019.runs.cases import at_speed
from validation.zeng2019.runs.measures import class_counts
from validation.zeng2019.runs.outcome import Outcome, outcome_of
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import UNKNOWABLE, Statement

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COEFFICIENTS = (0.0, 0.01, 0.05, 0.1)
SPEEDS = tuple(float(rpm) for rpm in range(7020, 14821, 1200))


def _pieces(size: Size) -> dict[float, dict[float, Piece]]:
    return {mu: {rpm: at_speed(size, rpm, mu) for rpm in SPEEDS} for mu in COEFFICIENTS}


def pieces(size: Size) -> Sequence[Piece]:
    """The same speeds with each coefficient."""
    return [piece for runs in _pieces(size).values() for piece in runs.values()]


def _runs(size: Size, found: Found) -> dict[float, dict[float, Outcome]]:
    return {mu: {rpm: outcome_of(found(piece)) for rpm, piece in runs.items()} for mu, runs in _pieces(size).items()}


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """One: what friction does to the classes."""
    every = _runs(size, found)
    told = "; ".join(f"{mu:g}: {class_counts(runs.values(), 'blisk')}" for mu, runs in every.items())
    moved = max(_apart(runs, every[0.0]) for runs in every.values())
    return [
        Statement(
            statement="The coefficient of friction between blades and casing.",
            verdict=UNKNOWABLE,
            found=f"motion of the blisk at {len(SPEEDS)} speeds by coefficient: {told}; normal impulses a turn differ "
            f"from those without friction by up to {100 * moved:.0f} %",
            why="The table of parameters is lost.",
        )
    ]


def _apart(runs: dict[float, Outcome], smooth: dict[float, Outcome]) -> float:
    """Largest relative difference of the impulses at the same speed, of runs that did not fail."""
    pairs = [(run.impulse, smooth[rpm].impulse) for rpm, run in runs.items() if run.ok and smooth[rpm].ok]
    return max((abs(one / other - 1) for one, other in pairs if other > 0), default=0.0)


def figures(size: Size, found: Found) -> dict[str, Figure]:
    """Impulse over speed, one line for each coefficient."""
    figure = new_figure(6.0, 2.8)
    axes = figure.subplots()
    for (mu, runs), color in zip(_runs(size, found).items(), (BLUE, GREEN, ORANGE, VERMILION), strict=True):
        good = {rpm: run.impulse for rpm, run in runs.items() if run.ok}
        axes.plot(list(good), list(good.values()), ".-", color=color, label=f"friction {mu:g}", linewidth=0.8)
    axes.legend(frameon=False, fontsize=8)
    style(axes, "Speed, rev/min", "Impulse a turn, N s")
    return {"Mean normal impulse a turn, by coefficient of friction; diverged runs are left out": figure}


SECTION = Section(
    name="friction",
    title="Frictionless against frictional",
    text="All other sections have no friction. Here the same speeds are run with Coulomb friction.",
    pieces=pieces,
    statements=statements,
    figures=figures,
)
