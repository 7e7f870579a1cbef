"""Figures 12 to 15: the regions II to V from near."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from validation.piece import Found, Piece
from validation.zeng2019.drawing.sweep_figure import COLOR_NAMES, sweep_figure
from validation.zeng2019.runs.cases import REGIONS, outcomes, speed_sweep, within
from validation.zeng2019.runs.outcome import Outcome
from validation.zeng2019.runs.region import CHAOTIC, MULTIPLE, PERIODIC, one_class, switching
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import Statement

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FIGURES = {"12": "II", "13": "III", "14": "IV", "15": "V"}
Judge = Callable[[str, dict[float, Outcome], list[Outcome], bool], Sequence[Statement]]
"""Of a region's name, its runs, all runs, and whether its classes were fitted."""
MASS = "How much of a sweep is chaotic depends on the casing's mass, which is not published."


def _second(where: str, runs: dict[float, Outcome], every: list[Outcome], fitted: bool) -> Sequence[Statement]:
    return [
        *one_class(where, PERIODIC, "blisk", runs, every, fitted=fitted),
        *one_class(where, CHAOTIC, "casing", runs, every, MASS, fitted=fitted),
    ]


def _third(where: str, runs: dict[float, Outcome], every: list[Outcome], fitted: bool) -> Sequence[Statement]:
    middle = sum(REGIONS["III"]) / 2
    low, high = within(runs, 0, middle), within(runs, middle + 1, 1e9)
    return [
        *one_class(f"{where}, first half", CHAOTIC, "blisk", low, every, fitted=fitted),
        *one_class(f"{where}, second half", PERIODIC, "blisk", high, every, MASS, fitted=fitted),
        *switching(where, (CHAOTIC, MULTIPLE, PERIODIC), "casing", runs, every),
    ]


def _fourth(where: str, runs: dict[float, Outcome], every: list[Outcome], _fitted: bool) -> Sequence[Statement]:
    return [one for part in PARTS for one in switching(where, (PERIODIC, CHAOTIC), part, runs, every)]


def _fifth(where: str, runs: dict[float, Outcome], every: list[Outcome], fitted: bool) -> Sequence[Statement]:
    return [one for part in PARTS for one in one_class(where, CHAOTIC, part, runs, every, MASS, fitted=fitted)]


PARTS = ("blisk", "casing")
JUDGES: dict[str, Judge] = {"II": _second, "III": _third, "IV": _fourth, "V": _fifth}


def _section(number: str, region: str) -> Section:
    low, high = (float(rpm) for rpm in REGIONS[region])

    def pieces(size: Size) -> Sequence[Piece]:
        return list(speed_sweep(size).values())

    def statements(size: Size, found: Found) -> Sequence[Statement]:
        runs = outcomes(speed_sweep(size), found)
        return JUDGES[region](f"Region {region}", within(runs, low, high), list(runs.values()), size.fitted)

    def figures(size: Size, found: Found) -> dict[str, Figure]:
        runs = within(outcomes(speed_sweep(size), found), low, high)
        return {f"Region {region} ({COLOR_NAMES})": sweep_figure(runs, "Speed, rev/min")}

    return Section(
        name=number,
        title=f"Figure {number}: region {region} from near",
        text=f"{low:,.0f} to {high:,.0f} rev/min in steps of 30. Statements about what the eye "
        "sees are judged in the diagram of the whole sweep.",
        pieces=pieces,
        statements=statements,
        figures=figures,
        compared=True,
    )


SECTIONS = tuple(_section(number, region) for number, region in FIGURES.items())
