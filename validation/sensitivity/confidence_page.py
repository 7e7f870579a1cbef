"""`docs/confidence.md` from the pairs of runs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from rubgen.labels.labels import Motion
from rubgen.labels.motion.classify import Motions
from validation.markdown import folded, table
from validation.sensitivity.confidence import KEPT_WHERE_SURE, SURE, bins, interval, shared, spreads, sure
from validation.sensitivity.recipes import RECIPES, RUNS, SEEDS, SEEN, Halved

TEXT = """
# What a confidence is worth

`motion_confidence` says how surely a run keeps its class of motion with half the step. A class is kept if class and
period of the whole system are equal.

`python -m validation.sensitivity recipes` makes this page from runs of the recipes with a steady speed, with 1,024 and
with 2,048 steps a turn, for two seeds of each recipe. Only runs that rub are compared: without contact the class cannot
change. At a changing speed the motion of a run with contact is always `undecided`.

The constants of the confidence were set by 106 runs of the first seed ("fit"). The second seed ("check") shows what the
confidence is worth. Its first 16 runs of each recipe were known when the constants were set; its later runs were looked
at only afterwards.

![Reliability of the confidence](confidence.png)
"""


def confidence_page(pairs: Mapping[str, Sequence[Halved]]) -> str:
    """The page; `pairs` by their use."""
    every = [pair for group in pairs.values() for pair in group]
    parts = [TEXT.strip(), _sizes(pairs), _by_recipe(every), _reliability(pairs), _causes(every), _spreads(pairs)]
    return "\n\n".join([*parts, _moved(every)]) + "\n"


def _sizes(pairs: Mapping[str, Sequence[Halved]]) -> str:
    counts = ", ".join(f"{use} (seed {SEEDS[use]}) {len(group)}" for use, group in pairs.items())
    return f"Pairs that are finished: {counts}; the whole study tries the first {RUNS} runs of each recipe and seed."


def _by_recipe(pairs: Sequence[Halved]) -> str:
    rows = []
    for recipe in RECIPES:
        own = [pair for pair in pairs if pair.run.recipe == recipe]
        decided = [pair for pair in own if pair.whole.system.motion is not Motion.UNDECIDED]
        kept = sum(pair.kept for pair in decided)
        classes = Counter(pair.whole.system.motion for pair in own)
        named = ", ".join(f"{classes[motion]} {motion.value}" for motion in Motion if classes[motion])
        rows.append([recipe, named, str(len(own)), str(len(decided)), str(kept), _percent(kept, len(decided))])
    header = ["recipe", "classes at 1,024 steps", "rubbing runs", "decided", "kept", "kept, %"]
    return table(header, rows, numbers_from=2)


def _reliability(pairs: Mapping[str, Sequence[Halved]]) -> str:
    rows = []
    for use, group in pairs.items():
        for each in bins(group):
            span = f"{each.low:g} to {each.high:g}"
            share = _percent(each.kept, each.runs)
            rows.append([use, span, f"{each.mean_confidence:.3f}", str(each.runs), str(each.kept), share, ""])
        rows.append(_sure_row(use, group))
    rows.append(_sure_row(f"check, run {SEEN} on", [pair for pair in pairs["check"] if pair.run.index >= SEEN]))
    header = ["runs of", "confidence", "mean", "decided runs", "kept", "kept, %", "95 % interval (Wilson)"]
    required = (
        f"Required: of runs with a confidence of {SURE:g} or more, {100 * KEPT_WHERE_SURE:.0f} % keep their class."
    )
    return f"{required}\n\n{table(header, rows, numbers_from=2)}"


def _sure_row(name: str, pairs: Sequence[Halved]) -> list[str]:
    runs, kept = sure(pairs)
    between = " to ".join(f"{100 * end:.1f}" for end in interval(kept, runs)) if runs else "-"
    return [name, f"**{SURE:g} to 1**", "", str(runs), str(kept), f"**{_percent(kept, runs)}**", between]


def _causes(pairs: Sequence[Halved]) -> str:
    decided = [pair for pair in pairs if pair.whole.system.motion is not Motion.UNDECIDED]
    every, lost = Counter(map(shared, decided)), Counter(shared(pair) for pair in decided if not pair.kept)
    rows = [[name, str(count), str(lost[name]), _percent(lost[name], count)] for name, count in every.items()]
    header = ["at 1,024 steps", "decided", "moved", "%"]
    return f"What runs share whose class moves:\n\n{table(header, rows, numbers_from=1)}"


def _spreads(pairs: Mapping[str, Sequence[Halved]]) -> str:
    rows = [
        [use, name, str(each.pairs), f"{each.rms:.3f}", f"{each.median:.3f}"]
        for use, group in pairs.items()
        for name, each in spreads(group).items()
    ]
    header = ["runs of", "indicator", "pairs", "rms change", "median size"]
    start = "What half the step changes; strays and exponents in decades (1 is a factor of ten), K as it is:"
    return f"{start}\n\n{table(header, rows, numbers_from=2)}"


def _moved(pairs: Sequence[Halved]) -> str:
    rows = [
        [
            pair.run.name,
            f"{pair.run.scenario.operation.speed_rpm:.0f}",
            f"{_class(pair.whole)} / {_class(pair.half)}",
            f"{pair.confidence:.2f}",
            " / ".join(f"{max(part.stray for part in each.indicators):.1e}" for each in (pair.whole, pair.half)),
            " / ".join(f"{each.indicators[0].growth:.2f}" for each in (pair.whole, pair.half)),
            " / ".join(_exponent(each) for each in (pair.whole, pair.half)),
        ]
        for pair in pairs
        if not pair.kept
    ]
    header = ["run", "rev/min", "motion", "confidence", "largest stray", "K", "exponent a turn"]
    return folded(f"{len(rows)} classes that move (1,024 / 2,048 steps)", table(header, rows))


def _class(found: Motions) -> str:
    system = found.system
    return f"period-{system.period}" if system.motion is Motion.PERIOD_K else system.motion.value


def _exponent(found: Motions) -> str:
    exponent = found.indicators[0].exponent
    return f"{exponent.per_turn:+.3f} +- {exponent.error:.3f}" if exponent else "-"


def _percent(part: int, whole: int) -> str:
    return f"{100 * part / whole:.1f}" if whole else "-"
