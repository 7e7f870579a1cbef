"""Conclusion (3): the casing's support matters more than the blisk's; the casing is the more sensitive part."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, Literal

import numpy as np
from scipy.stats import qmc, sobol_indices

from rubgen.arrays import FloatArray
from rubgen.scenario import Recipe, Scenario, load_recipe
from rubgen.scenario.vary import vary
from rubgen.viz.colors import BLUE, ORANGE
from validation.piece import Arrays, Found, Piece
from validation.zeng2019.drawing.style import new_figure, style
from validation.zeng2019.figures.figure17 import curve
from validation.zeng2019.runs.cases import PRINTED, casing_sweep, disk_sweep, outcomes
from validation.zeng2019.runs.measures import motion_of, rubbing
from validation.zeng2019.runs.outcome import Outcome, outcome_of, run
from validation.zeng2019.section import Section
from validation.zeng2019.size import AS_COMPUTED, Size, sizes
from validation.zeng2019.statement import DIFFERS, UNKNOWABLE, Reading, Statement, counted, read_as, yes_or_no

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SETTLE, RECORD = 60, 100
"""Turns of these runs: rms values need no label."""
SEED = 20190
Sweeps = tuple[dict[float, Outcome], dict[float, Outcome]]
"""The runs over the disk's support, and over the casing's."""
RESAMPLES = 1000
QUANTITIES = ("blisk_rms", "casing_rms")
DISK, CASING = "disk_support_stiffness_n_per_m", "casing_support_stiffness_n_per_m"


@dataclass(frozen=True, kw_only=True)
class Indices:
    """Total Sobol indices (quantities, keys) with their 95 % intervals, low and high."""

    total: FloatArray
    low: FloatArray
    high: FloatArray


@cache
def recipe() -> Recipe:
    """The recipe that comes with rubgen; its ranges are those of the indices."""
    return load_recipe()


@cache
def keys() -> tuple[str, ...]:
    """What the recipe varies."""
    return tuple(entry.key for entry, _ in recipe().distributions())


def row(index: int, given: Scenario) -> Arrays:
    """`values` (2 + d, 2): rms of blisk and casing at the points A, B and A with one column of B each; NaN: failed.

    Saltelli's design; A and B are the halves of a scrambled Sobol sequence of twice the dimension. Machine and
    contact surface of `given` take the place of the recipe's.
    """
    count = len(keys())
    both = qmc.Sobol(2 * count, rng=SEED).random(2 ** index.bit_length())[index]
    points = [both[:count], both[count:]]
    points += [np.where(np.arange(count) == i, both[count:], both[:count]) for i in range(count)]
    return {"values": np.array([_rms(point, given) for point in points])}


def _rms(point: FloatArray, given: Scenario) -> tuple[float, ...]:
    drawn = {entry.key: law.quantile(float(u)) for (entry, law), u in zip(recipe().distributions(), point, strict=True)}
    scenario = vary(replace(recipe().base, machine=given.machine), drawn)
    turns = replace(scenario.operation, settle_turns=SETTLE, record_turns=RECORD)
    contact = replace(scenario.contact, surface=given.contact.surface)
    found = outcome_of(run(replace(scenario, operation=turns, contact=contact)))
    return tuple(getattr(found, name) if found.ok else float("nan") for name in QUANTITIES)


def _pieces(size: Size) -> list[Piece]:
    return [Piece(row, (index, size.scenario())) for index in range(size.samples)]


def pieces(size: Size) -> Sequence[Piece]:
    """The rows of the design, and the sweeps of both supports."""
    sweeps = [sweep for each in _both(size) for sweep in (disk_sweep(each), casing_sweep(each, PRINTED))]
    return [*_pieces(size), *(piece for sweep in sweeps for piece in sweep.values())]


def _both(size: Size) -> tuple[Size, Size]:
    """The size of each machine that has the sweeps of both supports."""
    return size, sizes(size)[AS_COMPUTED]


def _sweeps(size: Size, found: Found) -> Sweeps:
    return outcomes(disk_sweep(size), found), outcomes(casing_sweep(size, PRINTED), found)


def indices(values: FloatArray) -> Indices:
    """Total indices of `values` (n, 2 + d, s), n a power of two; failed runs count as the largest value there is.

    Intervals are percentiles over RESAMPLES draws of n rows with replacement, the same for the same values.
    """
    filled = np.where(np.isnan(values), np.nanmax(values, axis=(0, 1)), values)
    rng, count = np.random.default_rng(SEED), len(values)
    again = np.array([_total(filled[rng.integers(count, size=count)]) for _ in range(RESAMPLES)])
    low, high = np.nanpercentile(again, [2.5, 97.5], axis=0)
    return Indices(total=_total(filled), low=low, high=high)


def _total(values: FloatArray) -> FloatArray:
    """Total indices (s, d); NaN where all values are equal."""
    f: dict[Literal["f_A", "f_B", "f_AB"], FloatArray] = {
        "f_A": values[:, 0].T,
        "f_B": values[:, 1].T,
        "f_AB": values[:, 2:].transpose(1, 2, 0),
    }
    with np.errstate(divide="ignore", invalid="ignore"):
        total = sobol_indices(func=f, n=len(values)).total_order
    return np.reshape(total, (values.shape[2], values.shape[1] - 2))


def _values(size: Size, found: Found) -> FloatArray:
    return np.array([found(piece)["values"] for piece in _pieces(size)])


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """Support against support for each part, and part against part."""
    values = _values(size, found)
    failed = int(np.isnan(values[..., 0]).sum())
    of = indices(values)
    note = f"{values.shape[0] * values.shape[1]} runs, {failed} of them diverged and count as the largest value."
    sweeps = [_sweeps(each, found) for each in _both(size)]
    more = [_more(part, of, row, note, sweeps) for row, part in enumerate(("blisk", "casing"))]
    return [*more, _sensitive(size, found)]


def _more(part: str, of: Indices, row: int, note: str, sweeps: list[Sweeps]) -> Statement:
    disk, casing = keys().index(DISK), keys().index(CASING)
    shown = ", ".join(f"{name} {_interval(of, row, column)}" for name, column in (("disk", disk), ("casing", casing)))
    apart = of.low[row, casing] > of.high[row, disk] or of.low[row, disk] > of.high[row, casing]
    verdict = yes_or_no(bool(of.total[row, casing] > of.total[row, disk])) if apart else UNKNOWABLE
    why = "" if apart else "The intervals overlap: this sample does not decide it. "
    return Statement(
        **read_as(*_other_readings(part, sweeps)),
        statement=f"The casing's support matters more than the blisk's (rms of the {part}).",
        verdict=verdict,
        found=f"total Sobol index with 95 % interval: {shown}",
        why=why + note,
    )


def _other_readings(part: str, sweeps: list[Sweeps]) -> tuple[Reading, Reading]:
    """The paper's own two sweeps, by the spread of the rms and by classes of motion, in place of Sobol indices."""
    where = "over the paper's own two sweeps at 10,000 rev/min, disk's support against casing's as printed"
    spread = [tuple(decades(runs, part) for runs in both) for both in sweeps]
    others = [tuple(uncommon(runs, part) for runs in both) for both in sweeps]
    by_class = [yes_or_no(casing[0] * disk[1] > disk[0] * casing[1]) for disk, casing in others]
    told = [f"{counted(*disk)} against {counted(*casing)}" for disk, casing in others]
    return (
        Reading(
            words=f"by the spread of the rms {where} (standard deviation of its decades "
            f"{f'; with {AS_COMPUTED} '.join(f'{disk:.2f} against {casing:.2f}' for disk, casing in spread)})",
            verdict=yes_or_no(spread[0][1] > spread[0][0]),
        ),
        Reading(
            words=f"by the class of motion {where} (runs that are not of their sweep's commonest class: {told[0]}; "
            f"with {AS_COMPUTED} {told[1]}: {by_class[1]})",
            verdict=by_class[0],
        ),
    )


def uncommon(runs: dict[float, Outcome], part: str) -> tuple[int, int]:
    """How many of the runs that rub do not move in the commonest class of their sweep, and how many rub."""
    classes = Counter(motion_of(run, part) for run in rubbing(runs).values())
    return classes.total() - max(classes.values(), default=0), classes.total()


def decades(runs: dict[float, Outcome], part: str) -> float:
    """Standard deviation of the decades of a part's rms over a sweep, without runs in which it rests."""
    _, rms = curve(runs, part)
    return float(np.std(np.log10(rms[rms > 0])))


def _interval(of: Indices, row: int, column: int) -> str:
    return f"{of.total[row, column]:.2f} [{of.low[row, column]:.2f}, {of.high[row, column]:.2f}]"


def _sensitive(size: Size, found: Found) -> Statement:
    runs = outcomes(disk_sweep(size), found)
    spread = {part: decades(runs, part) for part in ("blisk", "casing")}
    told = ", ".join(f"{part} {value:.2f}" for part, value in spread.items())
    return Statement(
        statement="The casing is more sensitive than the blisk to the state, such as to resonance.",
        verdict=DIFFERS if spread["casing"] <= spread["blisk"] else yes_or_no(True),
        found=f"standard deviation of the decades of rms over the sweep of the disk's support: {told}",
        why="Runs without contact, in which the casing rests, are left out of its value.",
    )


def figures(size: Size, found: Found) -> dict[str, Figure]:
    """Total indices with intervals."""
    of = indices(_values(size, found))
    figure = new_figure(8.0, 2.8)
    axes = figure.subplots()
    for row_, (part, color) in enumerate((("blisk", BLUE), ("casing", ORANGE))):
        place = np.arange(len(keys())) + 0.2 * row_ - 0.1
        span = np.maximum([of.total[row_] - of.low[row_], of.high[row_] - of.total[row_]], 0)
        axes.errorbar(place, of.total[row_], yerr=span, fmt="o", color=color, label=f"rms of the {part}", markersize=4)
    names = [key.removesuffix("_n_per_m").removesuffix("_rpm").removesuffix("_m").replace("_", "\n") for key in keys()]
    axes.set_xticks(np.arange(len(keys())), names, fontsize=7)
    axes.set_ylim(-0.05, 1.25)
    axes.legend(frameon=False, fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    style(axes, "", "Total Sobol index")
    return {"Total Sobol indices over the ranges of the embedded recipe, with 95 % intervals": figure}


SECTION = Section(
    name="c3",
    title="Conclusion (3): casing support against blisk support",
    text="Total Sobol indices (`scipy.stats.sobol_indices`) over the ranges of the recipe that comes with rubgen. "
    "These are not the ranges of the paper. The indices are those of `zeng2019` alone.",
    pieces=pieces,
    statements=statements,
    figures=figures,
)
