"""The evidence of the search as Markdown: what was tried, what each unknown is worth, which machine is taken."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from rubgen.arrays import FloatArray
from validation.markdown import folded, table
from validation.piece import Arrays, Found, Piece
from validation.zeng2019.fitting.candidate import PRESET, RECORD, SETTLE, Candidate
from validation.zeng2019.fitting.room import room
from validation.zeng2019.fitting.score import RESAMPLES, Score, always, as_computed, best, interval, resampled
from validation.zeng2019.fitting.search import DAMPING
from validation.zeng2019.fitting.targets import FITTED, PREDICTED, Target, words
from validation.zeng2019.runs.region import CHAOTIC, PERIODIC
from validation.zeng2019.size import AS_COMPUTED, MACHINE
from validation.zeng2019.statement import power

TITLE = "# A search for what the paper does not publish"
READ: dict[str, Callable[[Candidate], float | str]] = {
    "contact surface": lambda one: one.surface,
    "casing mass, times the lightest reading": lambda one: one.mass,
    "lateral and tilt damping": lambda one: one.damping,
    "friction": lambda one: one.friction,
    "casing springs, times those of the frequencies": lambda one: one.springs,
}
INTRODUCTION = f"""`make zeng2019-fit` runs this search (`python -m validation.zeng2019 --fit --out out/zeng2019`). It \
writes this page, the machine `{AS_COMPUTED}`, and the results as data, `validation/zeng2019/fitting/found.json`. \
`make zeng2019` makes this page again from the data, without a run.

The paper does not publish lateral damping, the casing's mass and springs, friction, unbalance and clearance. Its \
contact surface is published: chords between the nodes of the casing (its equations 4 to 6). rubgen uses the smooth \
curve. For each surface and each damping, unbalance and clearance follow from the speed at which rub begins and from \
the support stiffness at which it ends ([the preset](preset-zeng2019.md)). The casing's frequencies fix the ratio of \
its springs to its mass. The search also tries other springs: then the published frequencies belong to another support \
than the one of the speed sweep. First a grid of surface, mass and damping is run without friction. Then, for the best \
of each surface, friction and springs are varied. The damping of blades (0.4 %), of the casing (2 %), and of the axial \
and torsional supports is not varied. The presets `{MACHINE}` and `zeng2019-fitted` do not change."""
SCORE = """The score is a balanced accuracy: the mean of two hit rates, for the words `period-1` and for the words \
`chaotic`. A machine that is chaotic everywhere has 0.5, and so has one that is always in period-1 motion. The blisk \
is judged at the disk centre, as in the paper. Quasi-periodic motion counts as chaotic, because 49 points cannot \
distinguish them. The search did not use the words of the two sweeps of supports; they are held out."""
INTERVAL = f"""Intervals are the middle 95 % of {RESAMPLES:,} resamplings: of each kind of word as many are drawn, \
with replacement, as there are. Words at neighbouring speeds depend on each other, so the true intervals are wider. \
`wins` is the share of resamplings in which a candidate with this value has the best score (equals share it)."""
ROOM = """The table shows the range of unbalance and clearance that is compatible with the onset (between 6,660 and \
6,780 rev/min) and with the end of rub (between 6.70e8 and 6.75e8 N/m at 10,000 rev/min), on the smooth curve:"""
TAKEN = f"""`{AS_COMPUTED}` is the best candidate on chords without friction and with the springs of the \
frequencies: a machine file contains no friction, and the machine keeps the published frequencies. Of equals, the one \
that shares most values with `{MACHINE}` is taken."""
CANDIDATES = ("", "surface", "mass", "damping", "friction", "springs", "fitted", "held out")


ROOMS = {damping: Piece(room, (damping,)) for damping in DAMPING}


def page(scores: Sequence[Score], found_room: Found) -> str:
    """The whole page. `found_room` gives the arrays of ROOMS, the spans of unbalance and clearance by damping."""
    drawn, rooms = resampled(scores), {damping: found_room(piece) for damping, piece in ROOMS.items()}
    found, taken = best(scores), as_computed(scores)
    preset = next(one for one in scores if one.candidate == PRESET)
    ranked = sorted(scores, key=lambda one: -one.accuracy)
    named = [("best of all", found), (f"`{AS_COMPUTED}`", taken), (f"`{MACHINE}`", preset)]
    parts = [
        TITLE,
        INTRODUCTION,
        SCORE,
        table(("run", "blisk", "casing", ""), [_target_row(one) for one in FITTED + PREDICTED]),
        "## What was found",
        _runs(scores),
        table(
            CANDIDATES,
            [
                *(_row(name, one, drawn[:, scores.index(one)]) for name, one in named),
                *(_always_row(word) for word in (CHAOTIC, PERIODIC)),
            ],
        ),
        _sentence(found, drawn[:, scores.index(found)]),
        f"{TAKEN} {_conditions(scores)}",
        "## How well each is determined",
        INTERVAL,
        *(_profile(name, read, scores, drawn) for name, read in READ.items()),
        ROOM,
        table(("damping", "unbalance, kg m", "clearance, um"), [_room_row(*each) for each in rooms.items()]),
        "## All candidates",
        folded(
            f"{len(ranked)} candidates, best first",
            table(CANDIDATES, [_row(str(i), one, None) for i, one in enumerate(ranked, start=1)]),
        ),
    ]
    return "\n\n".join(parts) + "\n"


def _runs(scores: Sequence[Score]) -> str:
    return (
        f"{len(scores)} candidates were run at {len(FITTED + PREDICTED)} points, {SETTLE} turns to settle and {RECORD} "
        f"to judge. `fitted` is the balanced accuracy on the {len(words(FITTED))} words used, `held out` that on the "
        f"{len(words(PREDICTED))} others."
    )


def _sentence(found: Score, drawn: FloatArray) -> str:
    low, high = interval(drawn)
    better = low > always(CHAOTIC, FITTED)
    told = "On these words it is better" if better else "So no candidate is surely better than chaos everywhere"
    held = "better than" if found.held_out > always(CHAOTIC, PREDICTED) else "no better than"
    return (
        f"The best of all has {found.accuracy:.2f} [{low:.2f}, {high:.2f}], chaos everywhere 0.50. {told}. Its score "
        f"is the largest of many, so it is too high by selection; the held-out words give {found.held_out:.2f}, {held} "
        "chaos everywhere."
    )


def _conditions(scores: Sequence[Score]) -> str:
    free = best([one for one in scores if one.candidate.surface == "chords"])
    return (
        f"Without these two conditions the best on chords has {free.accuracy:.2f} with friction "
        f"{free.candidate.friction:g} and {free.candidate.springs:g} times the springs; the held-out words give "
        f"{free.held_out:.2f}."
    )


def _target_row(target: Target) -> list[str]:
    where = f"{target.speed_rpm:,.0f} rev/min"
    if target.disk_support is not None:
        where += f", disk support {power(target.disk_support)} N/m"
    if target.casing_support is not None:
        where += f", casing support {power(target.casing_support)} N/m as printed, times the casing's mass"
    return [where, target.blisk, target.casing, "fitted" if target in FITTED else "held out"]


def _row(name: str, one: Score, drawn: FloatArray | None) -> list[str]:
    values = [f"{read(one.candidate)}" for read in READ.values()]
    fitted = f"{one.accuracy:.3f}"
    if drawn is not None:
        low, high = interval(drawn)
        fitted += f" [{low:.2f}, {high:.2f}]"
    return [name, *values, fitted, f"{one.held_out:.3f}"]


def _always_row(motion: str) -> list[str]:
    told = [f"{always(motion, targets):.3f}" for targets in (FITTED, PREDICTED)]
    return [f"{motion} everywhere", "", "", "", "", "", *told]


def _profile(name: str, read: Callable[[Candidate], float | str], scores: Sequence[Score], drawn: FloatArray) -> str:
    rows = []
    winners = drawn >= drawn.max(axis=1, keepdims=True) - 1e-12
    shares = winners / winners.sum(axis=1, keepdims=True)
    for value in sorted({read(one.candidate) for one in scores}, key=str if name == "contact surface" else float):
        places = [i for i, one in enumerate(scores) if read(one.candidate) == value]
        top = best([scores[i] for i in places])
        low, high = interval(drawn[:, scores.index(top)])
        wins = float(np.sum(shares[:, places], axis=1).mean())
        rows.append([f"{value}", str(len(places)), f"{top.accuracy:.3f} [{low:.2f}, {high:.2f}]", f"{top.held_out:.3f}",
                     f"{100 * wins:.0f} %"])  # fmt: skip
    return table((name, "candidates", "best score", "held out", "wins"), rows)


def _room_row(damping: float, found: Arrays) -> list[str]:
    unbalance = " to ".join(power(value, 4) for value in found["unbalance"])
    return [f"{damping:g}", unbalance, " to ".join(f"{1e6 * value:.1f}" for value in found["clearance"])]
