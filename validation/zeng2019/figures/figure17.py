"""Figure 17: the sweep of the disk's lateral support at 10,000 rev/min."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from rubgen.arrays import FloatArray
from validation.piece import Found, Piece
from validation.zeng2019.drawing.sweep_figure import COLOR_NAMES, sweep_figure
from validation.zeng2019.runs.cases import END_OF_RUB, disk_sweep, outcomes, within
from validation.zeng2019.runs.measures import harmonics, rms, rubbing, strongest
from validation.zeng2019.runs.outcome import Outcome
from validation.zeng2019.runs.region import CHAOTIC, PERIODIC, one_class, switching
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import Statement, by_deviation, by_share, counted, power, yes_or_no

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ALTERNATING = (3.70e8, 5.45e8)
TRIP = 1.4e8
RESONANT, FAR = (1.2e8, 1.6e8), 3.0e8
AMPLIFIED = 2.0
"""An amplitude is amplified where it exceeds the one at 3e8 N/m so many times."""
Measure = Callable[[Outcome, str], float]
"""The amplitude of a part of a run."""


def pieces(size: Size) -> Sequence[Piece]:
    """The sweep."""
    return list(disk_sweep(size).values())


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """Classes, trip point, orders, amplification, end of rubbing."""
    runs = outcomes(disk_sweep(size), found)
    return [*_classes(runs), _trip(runs), *_orders(runs), _amplified(runs), *_end(runs)]


def _classes(runs: dict[float, Outcome]) -> Sequence[Statement]:
    every, (low, high) = list(runs.values()), ALTERNATING
    inside = within(runs, low, high)
    outside = {k: run for k, run in rubbing(runs).items() if k not in inside}
    name = "Disk support 3.70e8 to 5.45e8 N/m"
    return [
        *one_class("Disk support, all values", PERIODIC, "blisk", runs, every),
        *switching(name, (PERIODIC, CHAOTIC), "casing", inside, every),
        *one_class("Disk support outside that region", PERIODIC, "casing", outside, every),
    ]


def jump(runs: dict[float, Outcome]) -> float:
    """Stiffness midway where the casing's points change most for what the stiffness changes between two runs, N/m."""
    middle = np.array([np.median(run.points_casing) for run in runs.values()])
    values = np.array(list(runs))
    step = int(np.argmax(np.abs(np.diff(middle) / np.diff(values))))
    return float(values[step] + values[step + 1]) / 2


def _trip(runs: dict[float, Outcome]) -> Statement:
    below = {k: run for k, run in within(runs, 0, ALTERNATING[0]).items() if run.ok}
    found = jump(below)
    return Statement(
        statement="Below the alternating region the casing's points jump at one stiffness, 1.4e8 N/m.",
        verdict=by_deviation(found / TRIP - 1),
        found=f"they change fastest at {power(found)} N/m",
        why="At the resonance the phase of the whirl turns by 180 degrees, and so does the point of each turn.",
    )


def _orders(runs: dict[float, Outcome]) -> Sequence[Statement]:
    rub = list(rubbing(runs).values())
    odd = sum(strongest(harmonics(run.spectrum_blisk)[:9], 2) % 2 == 1 for run in rub)
    even = sum(strongest(harmonics(run.spectrum_casing)) % 2 == 0 for run in rub)
    force = sum(strongest(run.force_orders) % 2 == 0 for run in rub)
    return [
        Statement(
            statement="Disk support sweep: only odd orders show in the blisk.",
            verdict=by_share(odd, len(rub)),
            found=f"besides f_r the strongest is odd in {counted(odd, len(rub), 'rubbing runs')}",
        ),
        Statement(
            statement="Disk support sweep: only even orders stand out in the casing.",
            verdict=by_share(even, len(rub)),
            found=f"strongest at the point even in {counted(even, len(rub), 'rubbing runs')}, of the contact force in "
            f"{counted(force, len(rub), 'runs')}",
            why="A single point shows the odd shapes as well: see `causes`.",
        ),
    ]


def curve(runs: dict[float, Outcome], part: str, measure: Measure = rms) -> tuple[FloatArray, FloatArray]:
    """Stiffness and amplitude of a part, its rms unless another measure is given, without failed runs."""
    good = {k: run for k, run in runs.items() if run.ok}
    return np.array(list(good)), np.array([measure(run, part) for run in good.values()])


def amplification(runs: dict[float, Outcome], part: str, measure: Measure = rms) -> tuple[float, float]:
    """Where that amplitude of a part is largest, in N/m, and how many times the one at 3e8 N/m."""
    k, amplitude = curve(runs, part, measure)
    far = amplitude[int(np.argmin(np.abs(k - FAR)))]
    top = int(np.argmax(amplitude))
    return float(k[top]), float(amplitude[top] / far) if far > 0 else float("inf")


def _amplified(runs: dict[float, Outcome]) -> Statement:
    peaks = {part: amplification(runs, part) for part in ("blisk", "casing")}
    holds = all(RESONANT[0] <= k <= RESONANT[1] and times >= AMPLIFIED for k, times in peaks.values())
    told = ", ".join(f"{part} {times:.1f} times at {power(k)} N/m" for part, (k, times) in peaks.items())
    return Statement(
        statement="Amplitudes are clearly amplified in region I, around the trip point.",
        verdict=yes_or_no(holds),
        found=f"largest rms against that at 3e8 N/m: {told}",
    )


def _end(runs: dict[float, Outcome]) -> Sequence[Statement]:
    last = max(rubbing(runs))
    free = [run for k, run in runs.items() if k > last]
    first = min((k for k in runs if k > last), default=float("inf"))
    alone = sum(run.motion_casing == "static" for run in free)
    return [
        Statement(
            statement="Rubbing ends at 6.75e8 N/m.",
            verdict=by_deviation(first / END_OF_RUB[1] - 1),
            found=f"contact at {power(last)}, none from {power(first)} N/m on",
            why="Unbalance and clearance were fitted to it, with a clearance of 1 um at 6.75e8 N/m.",
            used_for_fitting=True,
        ),
        Statement(
            statement="Where rubbing has ended the casing stands still.",
            verdict=by_share(alone, len(free)),
            found=counted(alone, len(free)),
        ),
    ]


def figures(size: Size, found: Found) -> dict[str, Figure]:
    """The sweep as the paper shows it."""
    runs = {k / 1e8: run for k, run in outcomes(disk_sweep(size), found).items()}
    bands = {"trip": (1.4, 1.4), "II": (ALTERNATING[0] / 1e8, ALTERNATING[1] / 1e8)}
    figure = sweep_figure(runs, "Disk support, 1e8 N/m", bands=bands)
    return {f"Sweep of the disk's support at 10,000 rev/min ({COLOR_NAMES})": figure}


SECTION = Section(
    name="17",
    title="Figure 17: stiffness of the disk's support",
    text="The speed is 10,000 rev/min. The stiffness is the same along X and Y, in steps of 5e6 to 2e7 N/m. `II` is "
    "the paper's alternating region. `trip` is its trip point in region I; the paper does not state the ends of "
    "this region.",
    pieces=pieces,
    statements=statements,
    figures=figures,
    compared=True,
)
