"""`docs/contact-options.md` from the runs."""

from __future__ import annotations

from collections.abc import Sequence

from validation.contact_options.chords import Artefact
from validation.contact_options.runs import HEAVY_FRICTION, LINER, Found
from validation.markdown import table

COMMAND = "python -m validation.contact_options"


def page(options: Sequence[Found], heavy: Sequence[Found], artefact: Artefact, factor: float) -> str:
    """The page: options run by run, chords, the liner, heavy rub, and how far blades shorten."""
    parts = [_introduction(), _options(options), _chords(artefact), _liner(options), _heavy(heavy), _draw_in(factor)]
    return "\n\n".join(part.strip() for part in parts) + "\n"


def _introduction() -> str:
    return f"""
# Options of contact, heavy rub, and shortening blades

Made by `{COMMAND}` from runs of the preset `zeng2019`; the cases are those of [sensitivity](sensitivity.md), the
options those of [the model](model.md#options-of-contact). Each option is off by default.
"""


def _options(found: Sequence[Found]) -> str:
    rows = [
        [each.case, each.option, each.motion, _impulse(each), f"{1e3 * each.bent:.2f}", f"{1e6 * each.shortened:.2g}"]
        for each in found
    ]
    header = ["case", "option", "motion", "impulse a turn, N s", "tips bent, mm", "draw-in, um"]
    return f"""
## What the options do

{table(header, rows)}

Impulses are mean and standard deviation over the record's turns. The half thickness of the preset's casing, 0.65 mm,
moves friction's line of action by 0.16 % of the radius and no class of these runs, but where motion is chaotic every
change of the last digit makes another run.
"""


def _chords(artefact: Artefact) -> str:
    return f"""
## Chords between nodes

![Chords](contact-options-chords.png)

At {artefact.tip_speed:.0f} m/s of the tips, chords between the {len(artefact.hits)} nodes lie up to
{1e6 * artefact.inside.max():.0f} um inside the smooth curve, {1e6 * artefact.inside.mean():.0f} um in the mean, and
the speed at which they come nearer to a tip jumps at each node by {artefact.hits.min():.1f} to
{artefact.hits.max():.1f} m/s: every tip is hit at every node that it passes in contact. Above, a stretch of 5 nodes;
below, the first case (period-1 on the smooth surface) on both surfaces. The clearance at rest is that of the smooth
curve.
"""


def _liner(found: Sequence[Found]) -> str:
    rows = []
    for each in found:
        worn = each.worn
        if worn is None:
            continue
        first, last = each.impulse[:50].mean(), each.impulse[-50:].mean()
        rows.append(
            [
                each.case,
                each.option,
                f"{1e3 * worn.depth.max():.3f}",
                f"{1e9 * worn.volume:.0f}",
                f"{first:.3g}",
                f"{last:.3g}",
                f"{each.energy.wear_loss:.3g}",
                f"{each.energy.friction_loss:.3g}",
            ]
        )
    header = ["case", "option", "deepest, mm", "volume, mm3", "impulse, first 50", "last 50", "wear, J", "friction, J"]
    return f"""
## An abradable liner

![Liner](contact-options-liner.png)

Wear {LINER.wear_m2_per_n:g} m2/N (0.01 mm3 for each N m) and ten times that, on a track {1e3 * LINER.width_m:g} mm
wide.

{table(header, rows)}

Impulses a turn in N s are means of the record's first and last turns. The volume is the one in the profile and, to
rounding, the sum of what the contacts took. The liner opens the two narrow places; how far, and what motion remains
while it does, depends on the rate.
"""


def _heavy(found: Sequence[Found]) -> str:
    rows = [
        [
            f"{each.speed_rpm:,.0f}",
            each.motion,
            _impulse(each) if each.impulse.size else "-",
            f"{1e3 * each.bent:.1f}" if each.impulse.size else "-",
            f"{1e6 * each.shortened:.0f}" if each.impulse.size else "-",
            each.reason or "-",
        ]
        for each in found
    ]
    header = ["rev/min", "ends as", "impulse a turn, N s", "tips bent, mm", "draw-in, um", "reason"]
    return f"""
## Heavy rub near the critical speed

The preset with friction {HEAVY_FRICTION:g}, all else as it is; its critical speed is 8,776 rev/min.

{table(header, rows)}

Runs here settle into irregular motion in which the blades chatter by millimetres, or leave the range of the model,
10 mm, and are recorded as `diverged` with the branch that left first, the turn, the rates of growth over the last ten
turns and whether that was growth or an excursion of a motion that was that large all along. With blades bent by several
millimetres the model itself is at its end: see the draw-in.
"""


def _draw_in(factor: float) -> str:
    rows = [[f"{bent:g}", f"{1e6 * factor * (1e-3 * bent) ** 2:.2g}"] for bent in (0.1, 0.5, 1, 2, 5, 8)]
    return f"""
## Blades do not grow shorter

A linear beam that bends keeps its tip's radius; a real one draws it back by 1/2 int (v'^2 + w'^2) dx. From the static
shape of the preset's tapered, twisted blade under a force at its tip, where it is softest, that is {factor:.2f} 1/m
times the square of the tip's deflection (a uniform beam of that length has 4.00):

{table(["deflection, mm", "draw-in, um"], rows)}

The clearance is 272 um. The tables above give the deflection that each run reached (sections and the eight turns about
the hardest touch, the disk's motion taken off) and what the tip would have drawn back. With the default recipe's
friction it is a few micrometres at most and the term is left out; where blades chatter by more than 2 mm it is 17 um
and more, opens the gap just when a blade swings widest, and labels of such runs are those of the linear model.
"""


def _impulse(found: Found) -> str:
    return f"{found.impulse.mean():.4g} +- {found.impulse.std():.2g}" if found.impulse.size else "-"
