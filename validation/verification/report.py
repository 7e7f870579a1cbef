"""The verification table as text and as a page of the documents."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from validation.markdown import table
from validation.verification.row import Row

HEAD = """# Verification

These pages compare values that rubgen computes with independent values. Those come from a closed form, from the
literature, or from another method that was written for the purpose: shooting, Runge-Kutta, Rayleigh-Ritz, Bessel
determinants, dense full models.

A row is ok if |found - expected| is at most the tolerance, in the unit of the row. For a range, the expected value is
its middle. For a bound, the row counts the cases in which it is broken. Tolerances follow from the last digit of a
table and from observed convergence, as each section says. No tolerance was widened to pass. Found values are rounded
to a hundredth of the tolerance.

`make verification` makes these pages and `out/verification.json`. It fails if a row is not ok.

"""
PARTS = {
    "elements": "Elements: beams, plates, disks, rings",
    "rotors": "Rotors, supports, faults of the motion",
    "sensors": "Bearing defects and the frame",
    "contact": "Contact and integration in time",
    "chaos": "Chaos and Lyapunov exponents",
    "preset": "The preset",
}
"""The parts of the verification by the room of their modules, each a page."""


@dataclass(frozen=True)
class Group:
    """A section of the table: its title, how its values and tolerances come about, its rows."""

    title: str
    text: str
    rows: Sequence[Row]


def shown(value: float, tolerance: float) -> str:
    """The value rounded to a hundredth of the tolerance, so that rounding errors of a machine do not show."""
    if not math.isfinite(value):
        return str(value)
    if tolerance == 0:
        return f"{value:.12g}"
    places = 2 - math.floor(math.log10(tolerance))
    return f"{round(value, places) + 0.0:.12g}"


def line(row: Row) -> str:
    """One line for people at a terminal."""
    found, state = shown(row.found, row.tolerance), "ok" if row.ok else "NOT OK"
    return f"{row.quantity:<82} {row.expected:>14.9g} {found:>16} +- {row.tolerance:<9.2g} {state}"


def pages(groups: Mapping[str, Group], rooms: Mapping[str, str]) -> dict[str, str]:
    """The pages by their path in `docs/`: the first with the numbers of each part, then one for each part.

    `rooms` has the module of each group, such as `rotors.reduction`.
    """
    parts: dict[str, list[Group]] = {}
    for name, group in groups.items():
        parts.setdefault(rooms[name].partition(".")[0], []).append(group)
    rows = [row for group in groups.values() for row in group.rows]
    counts = [(f"[{PARTS[part]}](verification/{part}.md)", *_counts(found)) for part, found in parts.items()]
    first = HEAD + table(("part", "values", "ok", "not ok"), [*counts, ("all", *_count(rows))]) + "\n"
    return {"verification.md": first} | {
        f"verification/{part}.md": page(f"Verification: {PARTS[part][0].lower()}{PARTS[part][1:]}", found)
        for part, found in parts.items()
    }


def page(title: str, groups: Sequence[Group]) -> str:
    """A page of a part: a section with its table for each group."""
    head = f"# {title}\n\n[Verification](../verification.md) says how to read these tables.\n\n"
    return head + "\n".join(_section(group) for group in groups)


def _counts(groups: Sequence[Group]) -> tuple[str, str, str]:
    return _count([row for group in groups for row in group.rows])


def _count(rows: Sequence[Row]) -> tuple[str, str, str]:
    failed = sum(not row.ok for row in rows)
    return str(len(rows)), str(len(rows) - failed), str(failed)


def _section(group: Group) -> str:
    header = ("quantity", "source", "expected", "found", "tolerance", "ok")
    return f"## {group.title}\n\n{group.text}\n\n{table(header, [_cells(row) for row in group.rows])}\n"


def _cells(row: Row) -> tuple[str, ...]:
    return (
        row.quantity,
        row.source,
        f"{row.expected:.9g}",
        shown(row.found, row.tolerance),
        f"{row.tolerance:.2g}",
        "yes" if row.ok else "**no**",
    )


def summary(groups: Mapping[str, Group], seconds: Mapping[str, float]) -> str:
    """Rows, failures and the time of each group, for the end of a run."""
    rows = [row for group in groups.values() for row in group.rows]
    failed = [row.quantity for row in rows if not row.ok]
    times = ", ".join(f"{name} {seconds[name]:.1f} s" for name in groups)
    return "\n".join([f"{len(rows)} values, {len(failed)} not ok", *failed, times])
