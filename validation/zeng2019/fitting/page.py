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
`zeng2019-fitted` and `fit.json` in `out/zeng2019/fit`. The paper does not publish lateral damping, the casing's \
mass and springs, friction, unbalance and clearance. The search varies lateral damping, casing mass and friction on \
a grid. For each damping, unbalance and clearance follow from the speed at which rub begins and from the support \
stiffness at which it ends (`docs/preset-zeng2019.md`). The springs follow from the mass, because the casing's \
frequencies fix their ratio. The search does not vary the damping of blades (0.4 %), of the casing (2 %), and of \
the axial and torsional supports. These values were chosen, and this page does not confirm them. The preset \
`zeng2019` does not change. A machine has no friction, so `zeng2019-fitted` is the best candidate without friction."""
SCORE = """The score of a candidate is the number of the paper's words for the motion of blisk and casing with \
which its runs agree. Quasi-periodic motion counts as chaotic, because 49 points cannot distinguish them. Agreement \
with a fitted word is no evidence. The search did not use the words of the two sweeps of supports; they are \
predictions."""
BASELINE = """The last two rows are not candidates. They are the scores of a machine that is chaotic, or period-1, \
at every point. Most fitted words say chaotic, so a candidate may score more only because it is chaotic at more \
speeds. Of candidates with equal scores, the one that shares most values with `zeng2019` is taken."""
NOTHING = """The best of all agrees with {best} fitted words, chaos everywhere with {chaos}. So the classes of the \
regions II, III and V determine none of these unknowns. They only favour values that make more of the sweep \
chaotic."""
SOMETHING = """The best of all agrees with {best} fitted words, chaos everywhere with {chaos}. So the best \
candidate matches more than chaos."""
JUDGED = """These are the statements of the figures 10 and 12 to 18, judged with both machines, without friction, \
with speeds in steps of 240 rev/min. `(fitted)` marks statements to which that machine was fitted."""
CHANCE = """If each of {words} words agrees with the best candidate's probability, the count varies by {margin:.1f} \
by chance (one standard deviation of the binomial count). A value cannot be distinguished from the best if its best \
candidate lies within this margin of the best of all."""
ROOM = """The table shows the range of unbalance and clearance that is compatible with the onset (between 6,660 and \
6,780 rev/min) and with the end of rub (between 6.70e8 and 6.75e8 N/m at 10,000 rev/min):"""
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
