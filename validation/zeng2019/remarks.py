"""What the page says besides its numbers."""

from __future__ import annotations

from validation.zeng2019.size import FITTED, MACHINE, Size
from validation.zeng2019.statement import HALF, MOST, ROUNDING, TOLERANCE

TITLE = "The paper, reproduced"
INTRODUCTION = """J. Zeng, C. Zhao, H. Ma, K. Yu, B. Wen, *Rubbing dynamic characteristics of the blisk-casing system \
with elastic supports*, Aerosp. Sci. Technol. (2019), doi 10.1016/j.ast.2019.105481: its figures computed again and \
its statements, in our words, judged. `python -m validation.zeng2019` makes this page, its pictures and \
`statements.json`; the command under each heading makes that section alone. Contact is frictionless where nothing \
else is said. """
MACHINES = {
    MACHINE: """The machine is the preset `zeng2019` (`docs/preset-zeng2019.md`), whose dimensions, damping, unbalance \
and clearance are not published: what the preset was fitted to is marked `(fitted)` and proves nothing; everything \
else is a prediction.""",
    FITTED: """The machine is the preset `zeng2019-fitted` (`docs/zeng2019-fit.md`), which was fitted to the motion \
classes of the regions II, III and V as well: what it was fitted to is marked `(fitted)` and proves nothing; \
everything else is a prediction.""",
}


def rules(size: Size) -> str:
    """How verdicts are given, with the turns of the runs of that size."""
    return f"""Verdicts follow rules that were set before the runs. A number agrees within {100 * ROUNDING:g} %, \
agrees within what it is off by up to {100 * TOLERANCE:g} %, and differs beyond; accuracies of a reduction are taken \
at 2 %. A statement about many runs agrees where {100 * MOST:g} % of them bear it out, agrees within the rest down to \
{100 * HALF:g} %, and differs below. What needs a parameter or a drawing that is lost is unknowable. Motion classes \
are those of `docs/labels.md`, over {size.record_turns} turns after {size.settle_turns}, without the Lyapunov exponent \
(it would double the time). The paper judges 49 points by eye, which cannot tell quasi-periodic motion: it passes for \
chaotic, and for multi-period where the paper has that word; where the eye sees something else, both are given. A \
motion that the labels leave undecided bears out nothing."""


QUICK_REMARK = (
    "This is the quick version: few values, short runs. It shows that all works; its verdicts are worth little."
)
EVERY_REMARK = (
    "The speed is swept by more than the 30 rev/min of the paper's close-ups here, as the option `--every` of each "
    "command says: `--every 4` steps by 120 rev/min, the step of its whole sweep."
)
