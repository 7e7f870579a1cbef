"""Figure 6: convergence with the numbers of modes, and the Campbell diagram with its critical speed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.machine.published import BLISK_HZ
from rubgen.viz.colors import BLUE, GREEN, GREY, ORANGE, VERMILION
from validation.piece import Arrays, Found, Piece
from validation.zeng2019.drawing.style import new_figure, style
from validation.zeng2019.models.full import (
    blade_convergence,
    blisk_convergence,
    critical_speed,
    disk_convergence,
    spinning_frequencies,
)
from validation.zeng2019.models.reduced import campbell, reduced_frequencies
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import Statement, by_deviation, yes_or_no

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BLADE_COUNTS, DISK_COUNTS = [1, 2, 3, 4, 6, 8], [0, 1, 2, 3, 4, 6, 10]
BLISK_COUNTS = (4, 12, 40, 86)
REFERENCE, KEPT = 86, 4
FIRST = max(BLISK_HZ)
ACCURATE = 0.02
"""The paper calls frequencies accurate without a number: here within 2 % of the full model."""
LEAST_HZ = 50.0
"""Deviations are relative to this where a frequency is lower: near the critical speed one of them passes zero."""
FULL_DOF, REDUCED_DOF, REDUCTION = 15021, 125, 0.9917
CRITICAL_RPM = (8100.0, 8910.0)
COMPARED = 100

BLADE, DISK = Piece(blade_convergence, (BLADE_COUNTS,)), Piece(disk_convergence, (DISK_COUNTS,))
FULL_BLISK, FULL_CRITICAL = Piece(blisk_convergence, (COMPARED,)), Piece(critical_speed)
MORE_BLADE_MODES = Piece(reduced_frequencies, (REFERENCE, 8))
"""As many modes of the blisk, but eight of each blade."""


def reduced(modes: int) -> Piece:
    """Frequencies at rest with so many blisk modes, DoFs, critical speed."""
    return Piece(reduced_frequencies, (modes,))


def campbell_of(modes: int, size: Size) -> Piece:
    """The Campbell diagram with so many blisk modes."""
    return Piece(campbell, (modes, 15000.0, size.campbell_step))


def spinning(speed: float) -> Piece:
    """The full model at that speed, rev/min."""
    return Piece(spinning_frequencies, (speed, FIRST))


def pieces(size: Size) -> Sequence[Piece]:
    """Everything, the slowest first."""
    models = [reduced(modes) for modes in BLISK_COUNTS]
    diagrams = [campbell_of(modes, size) for modes in (REFERENCE, KEPT)]
    whole = [FULL_BLISK, *(spinning(speed) for speed in size.full_speeds), FULL_CRITICAL]
    return [*whole, BLADE, DISK, MORE_BLADE_MODES, *models, *diagrams]


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """Sizes, convergence, Campbell diagram, critical speed."""
    return [*_sizes(found), *_convergence(found), *_diagram(size, found)]


def _sizes(found: Found) -> Sequence[Statement]:
    kept = found(reduced(KEPT))
    full_dof, dof = int(kept["full_dof"]), int(kept["dof"])
    why = "180 casing nodes instead of 181: an odd number makes the ends of the minor axis differ."
    return [
        Statement(
            statement=f"The full model has {FULL_DOF:,} degrees of freedom.",
            verdict=by_deviation(full_dof / FULL_DOF - 1),
            found=f"{full_dof:,}",
            why=why,
        ),
        Statement(
            statement=f"The reduced model has {REDUCED_DOF} degrees of freedom.",
            verdict=yes_or_no(dof == REDUCED_DOF),
            found=str(dof),
            why="36 tips x 3, two of the disk centre, 4 blisk modes, 11 casing modes.",
        ),
        Statement(
            statement="The reduction removes 99.17 % of the degrees of freedom.",
            verdict=yes_or_no(round(1 - dof / full_dof, 4) == REDUCTION),
            found=f"{100 * (1 - dof / full_dof):.2f} %",
        ),
    ]


def _convergence(found: Found) -> Sequence[Statement]:
    blade = errors(found(BLADE))[BLADE_COUNTS.index(KEPT)]
    disk = errors(found(DISK))[DISK_COUNTS.index(KEPT)]
    four, most = blisk_errors(found, reduced(KEPT)), blisk_errors(found, reduced(REFERENCE))
    more = float(blisk_errors(found, MORE_BLADE_MODES)[:COMPARED].max())
    limit = "second" if more > ACCURATE else "first"
    tail = [float(errors(found(BLADE))[i].max()) for i in range(len(BLADE_COUNTS))]
    bad = int(np.argmax(four > ACCURATE)) if (four > ACCURATE).any() else len(four)
    return [
        _accurate("Four modes a blade give its first seven frequencies.", blade, _held(blade)),
        _accurate("Four modes give the disk's first seven frequencies.", disk),
        Statement(
            statement="The fewer modes are kept, the larger the error near the highest frequencies.",
            verdict=yes_or_no(bool(np.all(np.diff(tail) <= 0))),
            found="largest error of a blade's seven, "
            + ", ".join(f"{100 * e:.1f} % with {c}" for c, e in zip(BLADE_COUNTS, tail, strict=True)),
        ),
        _accurate(
            f"{REFERENCE} modes of the blisk give its first {COMPARED} frequencies.",
            most[:COMPARED],
            f"{_held(most)} With eight modes a blade in the first step instead of four the largest deviation is "
            f"{100 * more:.2f} %: the {limit} step limits the accuracy.",
        ),
        _accurate(f"Four modes of the blisk give its first {FIRST} frequencies.", four[:FIRST]),
        Statement(
            statement=f"Four modes of the blisk give no more than the first {FIRST} frequencies.",
            verdict=yes_or_no(bad == FIRST),
            found=f"frequency {bad + 1} is the first that is off by more than {100 * ACCURATE:.0f} % "
            f"({100 * four[min(bad, len(four) - 1)]:.1f} %)",
        ),
    ]


def _accurate(statement: str, error: FloatArray, why: str = "") -> Statement:
    worst = float(error.max())
    found = f"largest deviation from the full model {100 * worst:.2f} %, at frequency {int(error.argmax()) + 1}"
    return Statement(statement=statement, verdict=by_deviation(worst, ACCURATE), found=found, why=why)


def _held(error: FloatArray) -> str:
    """How many of them are within ACCURATE."""
    return f"{int(np.sum(error <= ACCURATE))} of {len(error)} are within {100 * ACCURATE:.0f} %."


def _diagram(size: Size, found: Found) -> Sequence[Statement]:
    few, many = found(campbell_of(KEPT, size)), found(campbell_of(REFERENCE, size))
    apart = np.abs(few["lowest"] - many["lowest"]) / np.maximum(many["lowest"], LEAST_HZ)
    of_full = {speed: _off_full(few["rpm"], few["lowest"], speed, found) for speed in size.full_speeds}
    critical, full = float(found(reduced(KEPT))["critical_speed_rpm"]), float(found(FULL_CRITICAL)["rpm"])
    low, high = CRITICAL_RPM
    return [
        Statement(
            statement=f"Up to 15,000 rev/min four blisk modes are as good as {REFERENCE}.",
            verdict=by_deviation(float(apart.max()), ACCURATE),
            found=f"the first {FIRST} differ by up to {100 * apart.max():.2f} %, the lowest four by "
            f"{100 * apart[:, :4].max():.2f} %",
            why="Against the full model the first 42 are off by up to "
            + ", ".join(f"{100 * error:.1f} % at {speed:,.0f} rev/min" for speed, error in of_full.items())
            + ": a basis of the blisk at rest does not contain all of the blades' stiffening.",
        ),
        Statement(
            statement="Region III (8,100 to 8,910 rev/min) lies at the critical speed.",
            verdict=yes_or_no(low <= critical <= high),
            found=f"forward lateral whirl at f_r: {critical:,.0f} rev/min",
        ),
        Statement(
            statement="The reduced model has the critical speed of the full one.",
            verdict=by_deviation(critical / full - 1),
            found=f"{critical:,.1f} rev/min, in the full model {full:,.1f}",
            why="Implied by the paper's Campbell diagram, which it draws from reduced models.",
        ),
    ]


def _off_full(rpm: FloatArray, lowest: FloatArray, speed: float, found: Found) -> float:
    """Largest deviation from the full model at that speed, relative to a frequency of LEAST_HZ at least."""
    full = found(spinning(speed))["hz"]
    return float(np.max(np.abs(lowest[int(np.argmin(np.abs(rpm - speed)))] - full) / np.maximum(full, LEAST_HZ)))


def errors(arrays: Arrays) -> FloatArray:
    """Relative deviations of reduced frequencies from the full ones."""
    return np.asarray(np.abs(arrays["reduced"] / arrays["full"] - 1), dtype=np.float64)


def blisk_errors(found: Found, piece: Piece) -> FloatArray:
    """Relative deviations of a reduced blisk's frequencies, as many as both models have of the first hundred."""
    full, few = found(FULL_BLISK)["hz"], found(piece)["hz"]
    count = min(len(full), len(few))
    return np.asarray(np.abs(few[:count] / full[:count] - 1), dtype=np.float64)


def figures(size: Size, found: Found) -> dict[str, Figure]:
    """Four panels, as in the paper."""
    figure = new_figure(9.5, 6.2)
    axes = figure.subplots(2, 2).ravel()
    for panel, piece, counts, title in (
        (axes[0], BLADE, BLADE_COUNTS, "one blade"),
        (axes[1], DISK, DISK_COUNTS, "disk"),
    ):
        for count, error in zip(counts, errors(found(piece)), strict=True):
            panel.semilogy(np.arange(1, 8), 100 * np.maximum(error, 1e-9), ".-", label=f"{count} modes", linewidth=0.8)
        style(panel, "Number of the frequency", "Off the full model, %", title)
        panel.legend(frameon=False, fontsize=7)
    for modes, color in zip(BLISK_COUNTS, (VERMILION, ORANGE, GREEN, BLUE), strict=True):
        error = blisk_errors(found, reduced(modes))
        axes[2].semilogy(1 + np.arange(len(error)), 100 * np.maximum(error, 1e-6), color=color, label=f"{modes} modes")
    axes[2].legend(frameon=False, fontsize=7)
    style(axes[2], "Number of the frequency", "Off the full model, %", "blisk")
    _draw_diagram(axes[3], size, found)
    caption = (
        "Convergence with the numbers of modes; Campbell diagram of one nodal diameter, in the inertial frame, circle: "
        "critical speed of the full model"
    )
    return {caption: figure}


def _draw_diagram(axes: Axes, size: Size, found: Found) -> None:
    diagram = found(campbell_of(KEPT, size))
    rpm = diagram["rpm"]
    for name, color in (("forward", BLUE), ("backward", GREY)):
        axes.plot(rpm, diagram[name], ".", color=color, markersize=1.5)
    axes.plot(rpm, rpm / 60, color=VERMILION, linewidth=0.9)
    full = float(found(FULL_CRITICAL)["rpm"])
    axes.plot(full, full / 60, "o", color=VERMILION, markersize=5, markerfacecolor="none")
    axes.axvspan(*CRITICAL_RPM, color=ORANGE, alpha=0.25, linewidth=0)
    axes.set(xlim=(0, 15000), ylim=(0, 600))
    style(axes, "Speed, rev/min", "Frequency, Hz", "forward blue, backward grey, $f_r$ red, III orange")


SECTION = Section(
    name="6",
    title="Figure 6: reduction and Campbell diagram",
    text="Frequencies are undamped. One blade is clamped at its root. The disk stands on its supports; the paper does "
    "not say how it supports the disk. The full model at speed is solved as a quadratic eigenproblem of all its "
    "degrees of freedom.",
    pieces=pieces,
    statements=statements,
    figures=figures,
)
