"""Figure 19: natural frequencies over the disk's support, and the resonances that follow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.reduction import reduce
from rubgen.scenario import Reduction
from rubgen.units import rad_per_s
from rubgen.viz.colors import BLUE, ORANGE, VERMILION
from validation.piece import Arrays, Found, Piece
from validation.zeng2019.drawing.style import new_figure, style
from validation.zeng2019.figures.figure17 import RESONANT, amplification, curve
from validation.zeng2019.models.reduced import SHOWN, model_of, seen_frequencies, whirl
from validation.zeng2019.runs.cases import SUPPORT_RPM, disk_sweep, outcomes
from validation.zeng2019.runs.measures import strongest_line
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import DIFFERS, Statement, by_deviation, power, yes_or_no

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CROSSINGS = (1.3e8, 1.5e8)
PARTS = ("blisk", "casing")
SWEPT = [8e7 + 5e6 * i for i in range(50)]


def over_support(stiffnesses: list[float]) -> Arrays:
    """`k` (s,) in N/m and `forward` (s, 12): forward whirl of one nodal diameter at 10,000 rev/min in Hz, inertial."""
    model, speed = model_of(4), rad_per_s(SUPPORT_RPM)
    rows = []
    for k in stiffnesses:
        support = replace(model.machine.disk_support, lateral_stiffness_n_per_m=k)
        on = reduce(replace(model.machine, disk_support=support), Reduction())
        values, vectors = whirl(on.blisk.M, 2 * speed * on.blisk.G, on.stiffness(speed))
        seen = np.sort(seen_frequencies(values, vectors, on.machine.blades.count, speed)) / (2 * np.pi)
        forward = seen[seen > 0][:SHOWN]
        rows.append(np.pad(forward, (0, SHOWN - len(forward)), constant_values=np.nan))
    return {"k": np.array(stiffnesses), "forward": np.array(rows)}


PIECE = Piece(over_support, (SWEPT,))


def crossings(k: FloatArray, frequencies: FloatArray, level: float) -> list[float]:
    """Values of k, by linear interpolation, at which a column of frequencies (s, m) crosses a level."""
    off = frequencies - level
    rows, columns = np.nonzero(off[1:] * off[:-1] < 0)
    before, after = off[rows, columns], off[rows + 1, columns]
    return sorted((k[rows] - before * (k[rows + 1] - k[rows]) / (after - before)).tolist())


def pieces(size: Size) -> Sequence[Piece]:
    """Frequencies, and the sweep of figure 17."""
    return [PIECE, *disk_sweep(size).values()]


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """Two crossings, and which part shows the resonance more."""
    lines, runs = found(PIECE), outcomes(disk_sweep(size), found)
    met = crossings(lines["k"], lines["forward"], SUPPORT_RPM / 60)
    told = ", ".join(power(k, 4) for k in met) or "none"
    peaks = {part: amplification(runs, part) for part in PARTS}
    by_line = {part: amplification(runs, part, strongest_line)[1] for part in PARTS}
    return [
        Statement(
            statement="A natural frequency crosses f_r at 1.3e8 N/m.",
            verdict=by_deviation(min((abs(k / CROSSINGS[0] - 1) for k in met), default=1.0)),
            found=f"crossings of forward whirl with f_r, in N/m: {told}",
        ),
        Statement(
            statement="Another natural frequency crosses f_r at 1.5e8 N/m.",
            verdict=DIFFERS if len(met) < 2 else by_deviation(met[1] / CROSSINGS[1] - 1),
            found=f"forward whirl crosses f_r {'once' if len(met) == 1 else f'{len(met)} times'}",
            why="A consistent model has one forward lateral whirl at f_r; mixed frames give two, see `causes`.",
        ),
        Statement(
            statement="The resonances of the spectra lie at these crossings.",
            verdict=yes_or_no(all(RESONANT[0] <= k <= RESONANT[1] for k, _ in peaks.values())),
            found=", ".join(f"{part} largest at {power(k)} N/m" for part, (k, _) in peaks.items()),
        ),
        Statement(
            statement="The resonance is clearer in the casing than in the blisk.",
            verdict=yes_or_no(peaks["casing"][1] > peaks["blisk"][1]),
            found=", ".join(f"{part} {times:.1f} times its rms at 3e8 N/m" for part, (_, times) in peaks.items()),
            by_words=yes_or_no(by_line["casing"] > by_line["blisk"]),
            other_words="by the strongest line of the spectra, which the paper draws here, in place of the rms ("
            + ", ".join(f"{part} {times:.1f} times that at 3e8 N/m" for part, times in by_line.items())
            + ")",
        ),
    ]


def figures(size: Size, found: Found) -> dict[str, Figure]:
    """Frequencies on the left, rms of both parts on the right."""
    lines, runs = found(PIECE), outcomes(disk_sweep(size), found)
    figure = new_figure(9.5, 3.0)
    left, right = figure.subplots(1, 2)
    left.plot(lines["k"] / 1e8, lines["forward"], ".", color=BLUE, markersize=2)
    left.axhline(SUPPORT_RPM / 60, color=VERMILION, linewidth=0.8)
    left.set_ylim(0, 300)
    style(left, "Disk support, 1e8 N/m", "Forward whirl, Hz")
    for part, color in (("blisk", BLUE), ("casing", ORANGE)):
        k, rms = curve(runs, part)
        share = np.where(rms > 0, rms / rms.max(), np.nan)
        right.semilogy(k / 1e8, share, ".-", color=color, label=part, linewidth=0.8)
    right.legend(frameon=False, fontsize=8)
    style(right, "Disk support, 1e8 N/m", "Rms over its largest")
    return {"Forward whirl of one nodal diameter at 10,000 rev/min (f_r red), and rms of the sweep": figure}


SECTION = Section(
    name="19",
    title="Figure 19: natural frequencies over the disk's support",
    text="All frequencies are in the inertial frame, where f_r is 166.67 Hz.",
    pieces=pieces,
    statements=statements,
    figures=figures,
    compared=True,
)
