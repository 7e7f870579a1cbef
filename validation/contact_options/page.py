"""`docs/contact-options.md` from the runs."""

from __future__ import annotations

from collections.abc import Sequence

from validation.contact_options.chords import Artefact
from validation.contact_options.matched import FIGURE_RPM
from validation.contact_options.runs import HEAVY_FRICTION, LINER, Found
from validation.markdown import folded, table

COMMAND = "python -m validation.contact_options"


def page(options: Sequence[Found], heavy: Sequence[Found], chords: str, factor: float) -> str:
    """The page: options run by run, `chords` (see `chords_section`), the liner, heavy rub, how far blades shorten."""
    parts = [_introduction(), _options(options), chords, _liner(options), _heavy(heavy), _draw_in(factor, options)]
    return "\n\n".join(part.strip() for part in parts) + "\n"


def _introduction() -> str:
    return f"""
# Options of contact, heavy rub, and shortening of blades

`{COMMAND}` makes this page from runs of the preset `zeng2019`. [Sensitivity](sensitivity.md) defines the cases.
[Options of contact](contact.md) defines the options. Each option is off by default.
Classes of motion are those of data sets: with a Lyapunov exponent whose companion trajectory stops once the exponent is
settled.
"""


def _options(found: Sequence[Found]) -> str:
    rows = [
        [each.case, each.option, each.motion, _impulse(each), f"{1e3 * each.bent:.2f}", f"{1e6 * each.shortened:.2g}"]
        for each in found
    ]
    header = ["case", "option", "motion", "impulse a turn, N s", "tips bent, mm", "draw-in, um"]
    return f"""
## Effects of the options

{table(header, rows)}

Impulses are mean and standard deviation over the turns of the record. The half thickness of the casing, 0.65 mm in
the preset, moves the line of action of friction by 0.16 % of the radius. It changes {_changed(found)}. In
chaotic motion every change of the last digit leads to another trajectory. The row of the chords has unbalance and
clearance fitted for chords: see below.
"""


def _changed(found: Sequence[Found]) -> str:
    """In how many cases the half thickness has another class of motion than the default law."""
    plain = {each.case: each.motion for each in found if each.option == "none"}
    moved = [each.case for each in found if each.option == "half_thickness" and each.motion != plain[each.case]]
    return f"the class of {', '.join(moved)}" if moved else "no class of these runs"


def chords_section(artefact: Artefact, matched: str) -> str:
    """The part of the page about chords; `matched` ends it."""
    return f"""
## Chords between nodes

![Chords](contact-options-chords.png)

Chords between the {len(artefact.hits)} nodes lie up to {1e6 * artefact.inside.max():.0f} um inside the smooth curve,
{1e6 * artefact.inside.mean():.0f} um in the mean. The tips move at {artefact.tip_speed:.0f} m/s. The speed at which
the surface approaches a tip jumps by {artefact.hits.min():.1f} to {artefact.hits.max():.1f} m/s at each node. So every
tip in contact has an impact at every node. The upper plots show a stretch of 5 nodes. The lower plots show the run at
{FIGURE_RPM:,.0f} rev/min on the smooth curve, and on chords at matched onset.

{matched.strip()}
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

The wear coefficient is {LINER.wear_m2_per_n:g} m2/N (0.01 mm3 for each N m), and ten times this value for the softer
liner. The track is {1e3 * LINER.width_m:g} mm wide.

{table(header, rows)}

Impulses a turn in N s are means over the first and the last 50 turns of the record. The volume is the volume of the
profile; to rounding, it equals the sum of the volumes that the contacts removed. Wear widens the two narrow places. The
rate of wear determines how far, and which motion remains.
"""


def _heavy(found: Sequence[Found]) -> str:
    rows = [
        [
            f"{each.speed_rpm:,.0f}",
            each.motion,
            _impulse(each) if each.impulse.size else "-",
            f"{1e3 * each.bent:.1f}" if each.impulse.size else "-",
            f"{1e6 * each.shortened:.0f}" if each.impulse.size else "-",
        ]
        for each in found
    ]
    header = ["rev/min", "ends as", "impulse a turn, N s", "tips bent, mm", "draw-in, um"]
    reasons = "\n".join(f"- {each.speed_rpm:,.0f} rev/min: {each.reason}" for each in found if each.reason)
    return f"""
## Heavy rub near the critical speed

The preset with friction {HEAVY_FRICTION:g}, nothing else changed. Its critical speed is 8,776 rev/min.

{table(header, rows)}

{folded("Reasons of the runs that diverged", reasons)}

Some of these runs settle into irregular motion in which the blades chatter by millimetres. The others leave the
range of the model, 10 mm, and are recorded as `diverged`. Their reason names the part that left first, the turn, and
the rates of growth over the last ten turns. It also says whether this was growth, or an excursion of a motion that
was always this large. With blades bent by several millimetres the model is no longer valid: see the draw-in.
"""


def _draw_in(factor: float, light: Sequence[Found]) -> str:
    largest = 1e6 * max(each.shortened for each in light)
    rows = [[f"{bent:g}", f"{1e6 * factor * (1e-3 * bent) ** 2:.2g}"] for bent in (0.1, 0.5, 1, 2, 5, 8)]
    return f"""
## Blades do not grow shorter

When a linear beam bends, its tip stays at the same radius. The tip of a real beam moves inward by 1/2 int (v'^2 +
w'^2) dx, the draw-in. For the tapered, twisted blade of the preset, this is {factor:.2f} 1/m times the square of the
tip deflection (4.00 for a uniform beam of the same length). The factor uses the static shape under a force at the
tip in its softest direction.

{table(["deflection, mm", "draw-in, um"], rows)}

The clearance is 272 um. The tables above show the largest deflection of each run and the draw-in of the tip at this
deflection. The deflection is taken from the sections and from the eight turns around the hardest touch, without the
motion of the disk. In the runs of the first table the draw-in is at most {largest:.2g} um, so the model neglects it. If
blades chatter by more than 2 mm, it is 17 um and more, and a real gap opens when a blade swings widest. The labels of
such runs describe the linear model.
"""


def _impulse(found: Found) -> str:
    return f"{found.impulse.mean():.4g} +- {found.impulse.std():.2g}" if found.impulse.size else "-"
