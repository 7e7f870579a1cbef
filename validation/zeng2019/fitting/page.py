"""The evidence of the fit as Markdown: what was tried, what each unknown is worth, what the result bears out."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from validation.markdown import table
from validation.piece import Arrays
from validation.zeng2019.fitting.score import Score, always, best, frictionless, words
from validation.zeng2019.fitting.search import FITTED, PREDICTED, PRESET, RECORD, SETTLE, Candidate, Target
from validation.zeng2019.size import Size
from validation.zeng2019.statement import Statement, power

TITLE = "# A fit of what the paper does not publish"
READ: dict[str, Callable[[Candidate], float]] = {
    "lateral and tilt damping": lambda one: one.damping,
    "casing mass and springs, times the lightest reading": lambda one: one.mass,
    "friction": lambda one: one.friction,
}
INTRODUCTION = """`python -m validation.zeng2019 --fit --out out/zeng2019` makes this page, the machine \
`zeng2019-fitted` and `fit.json` in `out/zeng2019/fit`. Not published are lateral damping, the casing's mass and \
springs, friction, unbalance and clearance. The first three are searched on a grid. For each damping unbalance and \
clearance follow from the speed at which rub begins and the support at which it ends (`docs/preset-zeng2019.md`); \
springs follow from the mass, since the casing's frequencies fix their ratio. Damping of blades (0.4 %), of the casing \
(2 %) and of the axial and torsional supports are not searched: they stay as they were chosen, and nothing here says \
that they are right. The preset `zeng2019` stays as it is. A machine carries no friction: `zeng2019-fitted` is the \
best candidate without it."""
SCORE = """The score counts the paper's words for the motion of blisk and casing that a run bears out. Quasi-periodic \
motion passes for chaotic, as 49 points cannot tell them apart. A fitted word that is borne out is no evidence; the \
words of the two sweeps of supports were not looked at by the search and are predictions."""
BASELINE = """The last two rows are no candidates: they tell what a machine would score that is chaotic, or period-1, \
at every point. Most fitted words say chaotic: a candidate that scores more than another may only be chaotic at more \
speeds. Of equal candidates the one that shares most values with `zeng2019` is taken."""
NOTHING = """The best of all bears out {best} fitted words, chaos everywhere {chaos}. So the classes of the regions \
II, III and V determine none of these unknowns; they only prefer what makes more of the sweep chaotic."""
SOMETHING = """The best of all bears out {best} fitted words, chaos everywhere {chaos}: more than that it is chaotic."""
JUDGED = """The statements of the figures 10 and 12 to 18, judged with both machines, without friction, the speed by \
240 rev/min. `(fitted)` marks what that machine was fitted to."""
CHANCE = """Of {words} words, each borne out with the best candidate's share, {margin:.1f} more or less are chance \
(one standard deviation of the binomial count). A value whose best candidate lies within that of the best of all \
cannot be told from the best."""
ROOM = """Unbalance and clearance, least and largest that onset (between 6,660 and 6,780 rev/min) and end of rub \
(between 6.70e8 and 6.75e8 N/m at 10,000 rev/min) leave:"""
CANDIDATES = ("", "damping", "casing mass", "friction", "fitted", "predicted")


def page(
    scores: Sequence[Score],
    rooms: dict[float, Arrays],
    judged: Sequence[Sequence[tuple[str, Statement]]],
    size: Size,
) -> str:
    """The whole page. `rooms` are the spans of unbalance and clearance by damping, `judged` statements by machine."""
    found, preset = best(scores), next(one for one in scores if one.candidate == PRESET)
    margin, ranked = spread(found), sorted(scores, key=lambda one: -one.fitted)
    runs = (
        f"{len(scores)} candidates were run at {len(FITTED + PREDICTED)} points, {SETTLE} turns to settle and {RECORD} "
        f"to judge. `fitted` are the {words(FITTED)} words used, `predicted` the {words(PREDICTED)} others."
    )
    parts = [
        TITLE,
        INTRODUCTION,
        SCORE,
        table(("run", "blisk", "casing", ""), [_target_row(one) for one in FITTED + PREDICTED]),
        "## What was found",
        runs,
        table(
            CANDIDATES,
            [
                _row("best of all", found),
                _row("best without friction, `zeng2019-fitted`", best(frictionless(scores))),
                _row("`zeng2019`", preset),
                *(_always_row(motion) for motion in ("chaotic", "period-1")),
            ],
        ),
        BASELINE,
        (NOTHING if found.fitted <= always("chaotic")[0] else SOMETHING).format(
            best=found.fitted, chaos=always("chaotic")[0]
        ),
        "## How well each is determined",
        CHANCE.format(words=words(FITTED), margin=margin),
        *(_profile(name, read, scores, margin) for name, read in READ.items()),
        ROOM,
        table(("damping", "unbalance, kg m", "clearance, um"), [_room_row(*one) for one in rooms.items()]),
        "## All candidates",
        table(CANDIDATES, [_row(str(i), one) for i, one in enumerate(ranked, start=1)]),
        "## Statements with both machines",
        JUDGED,
        _counts(judged),
        table(("figure", "statement", "zeng2019", "zeng2019-fitted"), _side_by_side(*judged)),
    ]
    return "\n\n".join(parts) + ("" if size.name == "full" else "\n\nThis is the quick version.") + "\n"


def spread(found: Score) -> float:
    """Standard deviation of a binomial count with the share of words that the candidate bears out."""
    share = found.fitted / words(FITTED)
    return float((words(FITTED) * share * (1 - share)) ** 0.5)


def near(one: Score, found: Score, margin: float) -> bool:
    """Whether the candidate's count lies within the margin of the best one's."""
    return one.fitted >= found.fitted - margin


def _target_row(target: Target) -> list[str]:
    where = f"{target.speed_rpm:,.0f} rev/min"
    if target.disk_support is not None:
        where += f", disk support {power(target.disk_support)} N/m"
    if target.casing_support is not None:
        where += f", casing support {power(target.casing_support)} N/m as printed, times the casing's mass"
    return [where, target.blisk, target.casing, "fitted" if target in FITTED else "predicted"]


def _row(name: str, one: Score) -> list[str]:
    values = (one.candidate.damping, one.candidate.mass, one.candidate.friction)
    counts = (f"{one.fitted} of {words(FITTED)}", f"{one.predicted} of {words(PREDICTED)}")
    return [name, *(f"{value:g}" for value in values), *counts]


def _always_row(motion: str) -> list[str]:
    fitted, predicted = always(motion)
    counts = (f"{fitted} of {words(FITTED)}", f"{predicted} of {words(PREDICTED)}")
    return [f"{motion} everywhere", "", "", "", *counts]


def _profile(name: str, read: Callable[[Candidate], float], scores: Sequence[Score], margin: float) -> str:
    rows, found = [], best(scores)
    for value in sorted({read(one.candidate) for one in scores}):
        top = best([one for one in scores if read(one.candidate) == value])
        told = "within chance" if near(top, found, margin) else "scores less"
        rows.append([f"{value:g}", str(top.fitted), str(top.predicted), told])
    return table((name, "most words fitted", "predicted by it", ""), rows)


def _room_row(damping: float, found: Arrays) -> list[str]:
    unbalance = " to ".join(power(value, 4) for value in found["unbalance"])
    return [f"{damping:g}", unbalance, " to ".join(f"{1e6 * value:.1f}" for value in found["clearance"])]


def _counts(judged: Sequence[Sequence[tuple[str, Statement]]]) -> str:
    rows = []
    for name, statements in zip(("zeng2019", "zeng2019-fitted"), judged, strict=True):
        used = [one for _, one in statements if one.used_for_fitting]
        other = [one for _, one in statements if not one.used_for_fitting]
        told = [f"{sum(one.verdict.startswith('agrees') for one in kind)} of {len(kind)}" for kind in (other, used)]
        rows.append([name, *told])
    return table(("agrees, or agrees within X", "predictions", "used for fitting"), rows)


def _side_by_side(plain: Sequence[tuple[str, Statement]], fitted: Sequence[tuple[str, Statement]]) -> list[list[str]]:
    return [
        [title.split(":")[0], one.statement, _verdict(one), _verdict(other)]
        for (title, one), (_, other) in zip(plain, fitted, strict=True)
    ]


def _verdict(one: Statement) -> str:
    return one.verdict + (" (fitted)" if one.used_for_fitting else "")
