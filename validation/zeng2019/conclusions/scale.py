"""Why unbalance and clearance are not free, and why contact hardly moves the disk centre out of period-1."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rubgen.reduction import reduce
from rubgen.scenario import Reduction, Scenario
from rubgen.units import rad_per_s
from validation.onset import (
    AIR_AT_END_OF_RUB,
    END_OF_RUB_RPM,
    END_OF_RUB_STIFFNESS,
    ONSET_RPM,
    chord_inset,
    tip_growth,
)
from validation.piece import Arrays, Found, Piece
from validation.zeng2019.runs.cases import REGIONS, outcomes, speed_sweep, within
from validation.zeng2019.runs.measures import rubbing
from validation.zeng2019.runs.outcome import Outcome
from validation.zeng2019.section import Section, no_figures
from validation.zeng2019.size import Size
from validation.zeng2019.statement import EXPERIMENT, Statement, by_share, counted, yes_or_no

CLASS_BOUND = 0.01
"""Points that stray less than this share of the motion (rms) are a cluster: `docs/labels/motion.md`."""
FREE = 0.05
"""What the two equations may miss of the machine's own unbalance and clearance: they are linear in the unbalance."""


def reaches(scenario: Scenario) -> Arrays:
    """`growth` (2,) in m and `whirl` (2,) in m per kg m at the onset and at the end of rub; `inset` in m.

    Growth is the reach of the tips without unbalance, whirl the orbit of O_d for each kg m of unbalance.
    """
    machine = scenario.machine
    support = replace(machine.disk_support, lateral_stiffness_n_per_m=END_OF_RUB_STIFFNESS)
    growth, whirl = [], []
    for one, rpm in ((machine, ONSET_RPM), (replace(machine, disk_support=support), END_OF_RUB_RPM)):
        growth.append(tip_growth(replace(one, unbalance_kg_m=0.0), rpm))
        system = reduce(one, Reduction()).at_speed(rad_per_s(rpm))
        q = np.linalg.solve(system.K, system.force)
        whirl.append(float(np.hypot(*q[system.centre : system.centre + 2])) / machine.unbalance_kg_m)
    inset = chord_inset(machine) if scenario.contact.surface == "chords" else 0.0
    return {"growth": np.array(growth), "whirl": np.array(whirl), "inset": np.array(inset)}


def _piece(size: Size) -> Piece:
    return Piece(reaches, (size.scenario(),))


def pieces(size: Size) -> Sequence[Piece]:
    """The reaches of the tips, and the speed sweep."""
    return [_piece(size), *speed_sweep(size).values()]


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """Unbalance and clearance by two equations; contact force and scatter of the disk centre by region."""
    machine, runs = size.scenario().machine, rubbing(outcomes(speed_sweep(size), found))
    (g_1, g_2), (h_1, h_2), inset = (found(_piece(size))[name] for name in ("growth", "whirl", "inset"))
    unbalance = (g_2 - g_1 + AIR_AT_END_OF_RUB) / (h_1 - h_2)
    clearance = g_1 + h_1 * unbalance + inset
    off = unbalance / machine.unbalance_kg_m - 1, clearance / machine.casing.clearance_m - 1
    moved = [run for run in runs.values() if run.motion_casing not in ("period-1", "static")]
    inside = sum(stray(run) < CLASS_BOUND for run in moved)
    return [
        Statement(
            statement="Onset and end of rub fix unbalance and clearance.",
            verdict=yes_or_no(max(map(abs, off)) < FREE),
            found=f"g = {1e6 * g_1:.1f} and {1e6 * g_2:.1f} um, h = {h_1:.3g} and {h_2:.3g} m for each kg m: "
            f"U = {unbalance:.3g} kg m ({100 * off[0]:+.1f} % of the machine's), c = {1e6 * clearance:.1f} um "
            f"({100 * off[1]:+.1f} %)",
            apart=EXPERIMENT,
        ),
        Statement(
            statement="The mean contact force is a few hundredths of the unbalance force.",
            verdict=yes_or_no(max(map(_largest, _shares(machine.unbalance_kg_m, runs).values())) < FREE),
            found="contact over unbalance force, median and largest: "
            + ", ".join(
                f"{name} {100 * np.median(shares):.2f} % ({100 * _largest(shares):.2f} %)"
                for name, shares in _shares(machine.unbalance_kg_m, runs).items()
                if shares
            ),
            apart=EXPERIMENT,
        ),
        Statement(
            statement="Where the casing is not in period-1 motion, the disk centre still repeats within 1 % (rms).",
            verdict=by_share(inside, len(moved)),
            found=counted(inside, len(moved), "rubbing runs") + _strays(moved),
            apart=EXPERIMENT,
        ),
    ]


def _shares(unbalance: float, runs: dict[float, Outcome]) -> dict[str, list[float]]:
    """Mean contact force over the unbalance force by region: impulse a turn / (2 pi U Omega)."""
    return {
        name: [run.impulse / (2 * np.pi * unbalance * rad_per_s(rpm)) for rpm, run in within(runs, *span).items()]
        for name, span in REGIONS.items()
    }


def _strays(runs: list[Outcome]) -> str:
    return f"; its points stray by {100 * np.median([stray(run) for run in runs]):.2g} % (median)" if runs else ""


def _largest(shares: list[float]) -> float:
    return max(shares, default=0.0)


def stray(run: Outcome) -> float:
    """Rms scatter of the 49 points of the disk centre over the amplitude of its motion."""
    return float(run.points_blisk.std() / (np.sqrt(2) * run.blisk_rms))


SECTION = Section(
    name="scale",
    title="Scale: unbalance, clearance, and the disk centre",
    text="Until a tip touches, the machine is linear. The tip that reaches farthest has the reach g + h U: g is the "
    "steady growth by rotation, h U the orbit of the disk centre, in phase with the unbalance U or against it. Rub "
    "begins where the reach equals the clearance c, at 6,720 rev/min. It ends at 10,000 rev/min on 6.75e8 N/m, with 1 "
    "um of air. So c = g_1 + h_1 U = g_2 + h_2 U + 1 um, and U = (g_2 - g_1 + 1 um) / (h_1 - h_2). Growth does not "
    "depend on U or c, and sets the scale of both. (With damping the orbit is not exactly in phase, so the equations "
    "miss the fitted values a little; on chords c is larger by their inset.) A contact impulse p a turn is a mean "
    "force p Omega / (2 pi). The unbalance force is U Omega^2. Their ratio is p / (2 pi U Omega). If it is one "
    "hundredth, even a contact force that is irregular as a whole moves the disk centre by about one hundredth of its "
    "orbit, away from resonances. The third row counts how often this holds over the speed, on both surfaces. An eye "
    "hardly sees it in a diagram. The labels are finer: they call some of these motions chaotic all the same (figure "
    "12), and on soft supports of the casing the disk centre strays farther (figure 20). These rows are experiments "
    "of ours and are not counted.",
    pieces=pieces,
    statements=statements,
    figures=no_figures,
    compared=True,
)
