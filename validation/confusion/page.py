"""`docs/confusion.md` from the cases."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from rubgen.labels.labels import Motion
from validation.confusion.runs import SERIES, SPEEDS_RPM
from validation.confusion.verdicts import AGREE, Case, Cause, Clusters, Sign, ZeroOne
from validation.markdown import folded, table

COMMAND = "python -m validation.confusion"


def page(cases: Sequence[Case]) -> str:
    """The page: the table, causes of disagreement, every disagreement."""
    parts = [_introduction(cases), _confusion(cases), _classes(cases), _causes(cases), _disagreements(cases)]
    return "\n\n".join(part.strip() for part in parts) + "\n"


def _introduction(cases: Sequence[Case]) -> str:
    series = "\n".join(f"- {name}: {_keys(keys)}" for name, keys in SERIES.items())
    agree = sum(case.agree for case in cases)
    return f"""
# Three indicators of motion, and where they disagree

`{COMMAND}` makes this page from {len(cases)} runs of the preset `zeng2019` with rub, of 500 turns each, at
{SPEEDS_RPM[0]:,.0f} to {SPEEDS_RPM[-1]:,.0f} rev/min, in {len(SERIES)} series:

{series}

[The labels](labels/motion.md) use three indicators: clusters of the Poincare section, the 0-1 test, and the Lyapunov
exponent. They agree in {agree} runs. Each of the other {len(cases) - agree} was examined: which part strays most (disk
centre, tips, casing), by how much, and whether the motion still settles, repeats after 17 to 64 turns, is intermittent,
or is one spectral line.

![Exponent over stray](confusion.png)

*Above: exponent over stray, coloured by the 0-1 test. Below: agreement of each series over the speed.*
"""


def _confusion(cases: Sequence[Case]) -> str:
    count = Counter(case.verdict for case in cases)
    rows = [
        [clusters.value, test.value, *(_cell(count[clusters, test, sign], (clusters, test, sign)) for sign in Sign)]
        for clusters in Clusters
        for test in ZeroOne
    ]
    header = ["section", "0-1 test", *(f"exponent {sign.value}" for sign in Sign)]
    return f"""
## The table

Numbers of runs. Bold: all three indicators agree.

{table(header, rows)}
"""


def _cell(count: int, verdict: tuple[Clusters, ZeroOne, Sign]) -> str:
    return f"**{count}** {AGREE[verdict]}" if verdict in AGREE else str(count)


def _classes(cases: Sequence[Case]) -> str:
    count = Counter((case.motion, case.agree) for case in cases)
    rows = [
        [motion.value, str(count[motion, True]), str(count[motion, False])]
        for motion in Motion
        if count[motion, True] + count[motion, False]
    ]
    return f"""
## The label of these runs

{table(["`motion`", "indicators agree", "disagree"], rows)}
"""


def _causes(cases: Sequence[Case]) -> str:
    count = Counter(case.cause for case in cases if case.cause)
    rows = [[str(count[cause]), _name(cause), cause.value] for cause in Cause if count[cause]]
    return f"""
## Causes

{table(["runs", "name", "explanation"], rows)}

Clusters test whether the motion repeats at the scale of the motion. The other indicators have no scale. So in nearly
every disagreement the motion repeats at the scale of the motion and not at a smaller scale. The label uses the scale of
the motion. Its confidence is lower in such runs, and near the bound it is `undecided`. `stray_*`, `zero_one_k` and
`lyapunov_per_turn` describe the motion below this scale.
"""


def _disagreements(cases: Sequence[Case]) -> str:
    rows = [
        [
            case.name,
            " / ".join(verdict.value for verdict in case.verdict),
            f"{100 * case.stray:.2g}",
            case.group,
            f"{case.growth:.2f}",
            f"{case.exponent.per_turn:.4f} +- {case.exponent.error:.4f}",
            case.motion.value,
            _name(case.cause),
        ]
        for case in cases
        if case.cause
    ]
    header = [
        "run",
        "section / 0-1 / exponent",
        "strays, %",
        "strays most",
        "K",
        "exponent, 1/turn",
        "`motion`",
        "cause",
    ]
    return f"""
## Every disagreement

{folded(f"{len(rows)} runs, with the cause of each", table(header, rows))}
"""


def _name(cause: Cause) -> str:
    return cause.name.lower().replace("_", " ")


def _keys(keys: dict[str, float]) -> str:
    return ", ".join(f"`{key}` = {value:g}" for key, value in keys.items()) or "no change"
