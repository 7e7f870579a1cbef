"""Chords compared with the smooth curve: at the same clearance, and with the same air, that is at matched onset."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.machine import Machine
from rubgen.pipeline import Run
from rubgen.scenario import Scenario, make_scenario
from validation.markdown import table
from validation.onset import END_OF_RUB_RPM, chord_inset, fit_unbalance_and_clearance

SPEEDS_RPM = (9000.0, 9750.0, 10380.0, 10500.0, 10710.0, 10950.0, 11400.0, 12300.0, 13200.0, 14910.0)
ONSETS = ((6660.0, 1e8), (6780.0, 1e8), (END_OF_RUB_RPM, 6.4e8), (END_OF_RUB_RPM, 6.75e8))
"""Speed in rev/min and stiffness of the disk's support in N/m, around the onset and around the end of rub."""
FIGURE_RPM = 11400.0
"""The speed that the figure shows."""
SMOOTH, SAME, MATCHED = "smooth", "chords, same clearance", "chords, matched onset"
SURFACES = (SMOOTH, SAME, MATCHED)


@dataclass(frozen=True, kw_only=True)
class Compared:
    """A run on one of SURFACES: class of motion, rub, impulse a turn (record_turns,) in N s, centre (turns, 2) in m."""

    surface: str
    speed_rpm: float
    support: float
    motion: str
    rub: bool
    impulse: FloatArray
    centre: FloatArray


@cache
def matched(machine: Machine) -> Machine:
    """The machine with unbalance and clearance fitted for chords to the onset and the end of rub."""
    unbalance, clearance = fit_unbalance_and_clearance(machine, "chords")
    return replace(machine, unbalance_kg_m=unbalance, casing=replace(machine.casing, clearance_m=clearance))


def scenario(surface: str, speed_rpm: float, support: float = 1e8) -> Scenario:
    """The preset on one of SURFACES at a speed and with a stiffness of the disk's support in N/m."""
    smooth = make_scenario("zeng2019", speed_rpm=speed_rpm, disk_support_stiffness_n_per_m=support)
    if surface == SMOOTH:
        return smooth
    chords = replace(smooth, contact=replace(smooth.contact, surface="chords"))
    return on_matched_chords(smooth) if surface == MATCHED else chords


def on_matched_chords(smooth: Scenario) -> Scenario:
    """The scenario on chords, unbalance and clearance of its machine fitted for them on the preset's own support."""
    preset = make_scenario("zeng2019").machine
    machine = replace(matched(preset), disk_support=smooth.machine.disk_support)
    return replace(smooth, machine=machine, contact=replace(smooth.contact, surface="chords"))


def compared(surface: str, run: Run) -> Compared:
    """What a run shows."""
    labels, operation = run.labels, run.scenario.operation
    return Compared(
        surface=surface,
        speed_rpm=operation.speed_rpm,
        support=run.scenario.machine.disk_support.lateral_stiffness_n_per_m,
        motion=str(labels.motion) if labels else run.response.status.code,
        rub=bool(labels and labels.rub),
        impulse=run.response.impulse_per_turn,
        centre=run.response.section_q[:, 3 * run.response.n_blades :][:, :2].copy(),
    )


def matched_section(runs: Sequence[Compared], onsets: Sequence[Compared]) -> str:
    """The part of the page: both comparisons at each speed, and what they show."""
    preset = make_scenario("zeng2019").machine
    inset, clearances = chord_inset(preset), [1e6 * one.casing.clearance_m for one in (preset, matched(preset))]
    rows = [
        [f"{speed:,.0f}", *(f"{one.motion}, {_impulse(one)}" for one in _at(runs, speed))]
        for speed in sorted({run.speed_rpm for run in runs})
    ]
    ends: dict[tuple[float, float], list[str]] = {}
    for one in onsets:
        ends.setdefault((one.speed_rpm, one.support), []).append("rub" if one.rub else "no rub")
    where = [[f"{speed:,.0f}", f"{support / 1e8:g}e8", *rubs] for (speed, support), rubs in ends.items()]
    return f"""
### At the same clearance, and at matched onset

The clearance is the smallest gap of the smooth curve at rest. The narrowest place of the chords lies {1e6 * inset:.0f}
um farther inside. So at the same clearance the tips have {1e6 * inset:.0f} um less air. To separate this from the
effect of the nodes, unbalance and clearance are fitted for the chords as they were for the preset: to the speed at
which rub begins and to the support on which it ends ([the preset](preset-zeng2019.md)). The unbalance is the same. The
clearance is {clearances[1]:.1f} um instead of {clearances[0]:.1f} um.

{table(["rev/min", "disk support, N/m", *SURFACES], where)}

{table(["rev/min", *SURFACES], rows)}

The cells show the class of motion and the impulse a turn in N s, mean and standard deviation over the record.

{_findings(runs)}
"""


def _findings(runs: Sequence[Compared]) -> str:
    air, nodes, off = [], [], [0.0]
    for speed in sorted({run.speed_rpm for run in runs}):
        smooth, same, equal = _at(runs, speed)
        if equal.motion != smooth.motion:
            nodes.append(speed)
        elif same.motion != smooth.motion:
            air.append(speed)
            off.append(abs(equal.impulse.mean() / smooth.impulse.mean() - 1))
    return f"""\
- Chords at the same clearance change the class of motion, and chords at matched onset do not: {_list(air)}. There the
  missing air is the cause, not the nodes. The mean impulses at matched onset differ from those on the smooth curve by
  at most {100 * max(off):.1f} %.
- Chords at matched onset change the class: {_list(nodes)}. There the nodes are the cause."""


def _list(speeds: Sequence[float]) -> str:
    return f"{', '.join(f'{speed:,.0f}' for speed in speeds)} rev/min" if speeds else "no speed"


def _at(runs: Sequence[Compared], speed: float) -> list[Compared]:
    return [run for surface in SURFACES for run in runs if (run.surface, run.speed_rpm) == (surface, speed)]


def _impulse(one: Compared) -> str:
    return f"{one.impulse.mean():.4g} +- {np.std(one.impulse):.2g}" if one.impulse.size else "-"
