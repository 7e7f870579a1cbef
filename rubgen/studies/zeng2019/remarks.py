"""What the page says besides its numbers."""

from __future__ import annotations

from rubgen.studies.zeng2019.statement import HALF, MOST, ROUNDING, TOLERANCE

TITLE = "The paper, reproduced"
INTRODUCTION = """J. Zeng, C. Zhao, H. Ma, K. Yu, B. Wen, *Rubbing dynamic characteristics of the blisk-casing system \
with elastic supports*, Aerosp. Sci. Technol. (2019), doi 10.1016/j.ast.2019.105481: its figures computed again and \
its statements, in our words, judged. `rubgen reproduce zeng2019` makes this page, its pictures and \
`statements.json`; the command under each heading makes that section alone. The machine is the preset `zeng2019` \
(`docs/preset-zeng2019.md`), whose dimensions, damping, unbalance and clearance are not published: what the preset \
was fitted to is marked `(fitted)` and proves nothing; everything else is a prediction. Contact is frictionless where \
nothing else is said."""
RULES = f"""Verdicts follow rules that were set before the runs. A number agrees within {100 * ROUNDING:g} %, agrees \
within what it is off by up to {100 * TOLERANCE:g} %, and differs beyond; accuracies of a reduction are taken at 2 %. \
A statement about many runs agrees where {100 * MOST:g} % of them bear it out, agrees within the rest down to \
{100 * HALF:g} %, and differs below. What needs a parameter or a drawing that is lost is unknowable. Motion classes \
are those of `docs/labels.md`, over 500 turns after 150, without the Lyapunov exponent (it would double the \
time); the paper judges 49 points by eye, and where that makes a difference \
both are given."""
QUICK_REMARK = (
    "This is the quick version: few values, short runs. It shows that all works; its verdicts are worth little."
)
EVERY_REMARK = (
    "The speed is swept by more than the 30 rev/min of the paper's close-ups here, as the option `--every` of each "
    "command says: `--every 4` steps by 120 rev/min, the step of its whole sweep."
)
