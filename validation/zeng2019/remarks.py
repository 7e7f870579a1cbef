"""What the page says besides its numbers."""

from __future__ import annotations

from validation.zeng2019.size import AS_COMPUTED, MACHINE, TWIN, Size
from validation.zeng2019.statement import HALF, MOST, ROUNDING, TOLERANCE

TITLE = "The paper, reproduced"
INTRODUCTION = f"""J. Zeng, C. Zhao, H. Ma, K. Yu, B. Wen, *Rubbing dynamic characteristics of the blisk-casing \
system with elastic supports*, Aerosp. Sci. Technol. (2019), doi 10.1016/j.ast.2019.105481. These pages compute the \
figures of the paper again and judge its statements, in our words. `make zeng2019` makes these pages, their pictures \
and `statements.json`. The command under each heading makes only that section. Contact has no friction unless the text \
says so.

Two machines stand side by side (`docs/preset-zeng2019.md`). `{MACHINE}` is the machine of rubgen: contact on the \
smooth curve. `{AS_COMPUTED}` is the machine as the paper discretised it: contact on chords between the casing's \
nodes, unbalance and clearance fitted for chords, and eight times the lightest mass of the casing. On chords, without \
friction and with the published frequencies, no other mass of the search fits the paper's words better; ten and twelve \
times fit as well (`docs/zeng2019-fit.md`). \
It is for comparison, never for data. A third run of some statements, `{TWIN}`, has its \
casing and the same air, but the smooth curve, at every fourth speed and every second support: it separates chords \
from the casing. Figures show `{MACHINE}`.

The paper does not publish dimensions, damping, unbalance and clearance. `(fitted)` marks the values to which a \
machine was fitted; their agreement proves nothing. Everything else is a prediction. The paper's blisk is x of the \
disk centre. So statements on the blisk are judged by the class of the disk centre. Rows marked `(tips)` judge the \
same by the worst of the disk centre and the 36 tips. Rows marked `(experiment)` are hypotheses of ours about causes. \
Neither are statements of the paper, and the tables do not count them."""
DIFFERENCES = "Statements that differ, and why"
DIFFERENCES_TEXT = f"""Each statement of the paper that differs with `{MACHINE}`, with one main cause and the \
experiment that shows it. The first of these rules that applies decides. A row of figure 6 shows it. An experiment \
about the statement agrees. `{AS_COMPUTED}` agrees: contact geometry if `{TWIN}` does not, a lost dimension if it \
does. Another bound agrees. Another reading agrees. The twin agrees. Some candidate of the search agrees. \
`{AS_COMPUTED}` agrees by another bound or reading: again contact geometry if the twin does not. Sections on the \
blisk alone are run once, because both machines have the same blisk. No verdict changes by this."""


CHANGES = "The tally before and after"
CHANGES_TEXT = f"""Version 0.1.0 judged the statements on the blisk by the worst of disk centre and tips, and counted \
our own experiments. These pages judge the disk centre and count the statements of the paper only. These are the \
numbers with `{MACHINE}` before and after, and each statement whose kind of verdict changed. The rules of the verdicts \
are the same."""


def rules(size: Size) -> str:
    """How verdicts are given, with the turns of the runs of that size."""
    return f"""Verdicts follow rules that were set before the runs. A number agrees if it is within {
        100 * ROUNDING:g} %. Up to {
        100 * TOLERANCE:g} %, it agrees within its error. Beyond, it differs. For the accuracies of \
a reduction the first limit is 2 %.

A statement about many runs agrees if at least {100 * MOST:g} % of them \
confirm it. Down to {100 * HALF:g} %, it agrees within the share that does not confirm it. Below, it differs. A \
statement is unknowable if it needs a parameter or a drawing that is lost. A motion with the label undecided confirms \
no statement.

Motion classes are the classes of \
`docs/labels.md`, from {size.record_turns} turns after {size.settle_turns} turns of settling, without the \
Lyapunov exponent: no companion trajectory runs, because it would double the time.

The paper judges 49 points by eye, \
which cannot recognise quasi-periodic motion. Such motion counts as chaotic, and as multi-period where the paper has \
this word. What the eye sees is given as a number: how far the 49 points scatter, over the height of the diagram of \
the whole sweep; below 2 % they look like one point. If the verdict by this number is another one, the page states \
both."""


QUICK_REMARK = (
    "This is the quick version with few values and short runs. It shows that the commands work. Its verdicts mean "
    "little."
)
EVERY_REMARK = (
    "Here the steps of the speed are larger than the 30 rev/min of the paper's close-ups. The option `--every` of each "
    "command sets them: `--every 4` means steps of 120 rev/min, the step of the paper's whole sweep."
)
