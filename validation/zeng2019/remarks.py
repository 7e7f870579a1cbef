"""What the page says besides its numbers."""

from __future__ import annotations

from validation.zeng2019.size import FITTED, MACHINE, Size
from validation.zeng2019.statement import HALF, MOST, ROUNDING, TOLERANCE

TITLE = "The paper, reproduced"
INTRODUCTION = """J. Zeng, C. Zhao, H. Ma, K. Yu, B. Wen, *Rubbing dynamic characteristics of the blisk-casing \
system with elastic supports*, Aerosp. Sci. Technol. (2019), doi 10.1016/j.ast.2019.105481. This page computes the \
figures of the paper again and judges its statements, in our words. `python -m validation.zeng2019` makes this \
page, its pictures and `statements.json`. The command under each heading makes only that section. Contact has no \
friction unless the text says so. """
MACHINES = {
    MACHINE: """The machine is the preset `zeng2019` (`docs/preset-zeng2019.md`). The paper does not publish its \
dimensions, damping, unbalance and clearance. `(fitted)` marks the values to which the preset was fitted; their \
agreement proves nothing. Everything else is a prediction.""",
    FITTED: """The machine is the preset `zeng2019-fitted` (`docs/zeng2019-fit.md`), which was also fitted to the \
motion classes of the regions II, III and V. `(fitted)` marks the values to which it was fitted; their agreement \
proves nothing. Everything else is a prediction.""",
}


def rules(size: Size) -> str:
    """How verdicts are given, with the turns of the runs of that size."""
    return f"""Verdicts follow rules that were set before the runs. A number agrees if it is within {
        100 * ROUNDING:g} %. Up to {
        100 * TOLERANCE:g} %, it agrees within its error. Beyond, it differs. For the accuracies of \
a reduction the first limit is 2 %. A statement about many runs agrees if at least {100 * MOST:g} % of them \
confirm it. Down to {100 * HALF:g} %, it agrees within the share that does not confirm it. Below, it differs. A \
statement is unknowable if it needs a parameter or a drawing that is lost. Motion classes are the classes of \
`docs/labels.md`, from {size.record_turns} turns after {size.settle_turns} turns of settling, without the \
Lyapunov exponent (it would double the time). The paper judges 49 points by eye, which cannot recognise \
quasi-periodic motion. Such motion counts as chaotic, and as multi-period where the paper has this word. If the \
eye sees another class than the label, the page states both. A motion with the label undecided confirms no \
statement."""


QUICK_REMARK = (
    "This is the quick version with few values and short runs. It shows that the commands work. Its verdicts mean "
    "little."
)
EVERY_REMARK = (
    "Here the steps of the speed are larger than the 30 rev/min of the paper's close-ups. The option `--every` of each "
    "command sets them: `--every 4` means steps of 120 rev/min, the step of the paper's whole sweep."
)
