"""Figure 11: how the 49 points are taken."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rubgen.reduction import reduce
from rubgen.scenario import Scenario
from rubgen.solver import Status
from rubgen.solver.integrate import integrate
from rubgen.viz.colors import BLUE, VERMILION
from validation.piece import Arrays, Found, Piece
from validation.zeng2019.drawing.style import new_figure, style
from validation.zeng2019.runs.cases import case
from validation.zeng2019.runs.outcome import POINTS
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import UNKNOWABLE, Statement

if TYPE_CHECKING:
    from matplotlib.figure import Figure

RPM = 8820.0
SAMPLES = 64


def waveform(scenario: Scenario) -> Arrays:
    """`x` (49 * 64,) of O_d in m over the last 49 turns, the last value that of the last point."""
    model = reduce(scenario.machine, scenario.reduction)
    system = model.at_speed(scenario.operation.speed_rad_per_s)
    response = integrate(system, scenario.operation, scenario.contact)
    if response.status is not Status.OK:
        return {"x": np.full(POINTS * SAMPLES, np.nan)}
    stride = response.steps_per_turn // SAMPLES
    return {"x": response.taps["blisk_x"][::-stride][: POINTS * SAMPLES][::-1].copy()}


def _piece(size: Size) -> Piece:
    return Piece(waveform, (case(size, speed_rpm=RPM),))


def pieces(size: Size) -> Sequence[Piece]:
    """One run."""
    return [_piece(size)]


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """Its values are in the drawing, which is lost."""
    x = 1e6 * found(_piece(size))["x"]
    points = x[SAMPLES - 1 :: SAMPLES]
    return [
        Statement(
            statement="The waveform of the disk centre at 8,820 rev/min over the last 49 turns.",
            verdict=UNKNOWABLE,
            found=f"{x.min():.0f} to {x.max():.0f} um; the {len(points)} points span {np.ptp(points):.1f} um",
            why="The scan contains no values of the drawing.",
        )
    ]


def figures(size: Size, found: Found) -> dict[str, Figure]:
    """The waveform and its points."""
    x = 1e6 * found(_piece(size))["x"]
    turns = np.arange(1 - len(x), 1) / SAMPLES
    figure = new_figure(9.5, 2.2)
    axes = figure.subplots()
    axes.plot(turns, x, color=BLUE, linewidth=0.6)
    axes.plot(turns[SAMPLES - 1 :: SAMPLES], x[SAMPLES - 1 :: SAMPLES], ".", color=VERMILION, markersize=4)
    style(axes, "Turns before the end", "Disk centre $x$, µm")
    return {"Disk centre at 8,820 rev/min, and its position once a turn": figure}


SECTION = Section(
    name="11",
    title="Figure 11: from the waveform to 49 points",
    text="The section has one point a turn. Turns are counted back from the end.",
    pieces=pieces,
    statements=statements,
    figures=figures,
)
