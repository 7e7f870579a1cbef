"""Where physics and paper part: suspected causes switched on and off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rubgen.scenario import Reduction, Scenario
from rubgen.viz.colors import BLUE, GREEN, ORANGE, VERMILION
from validation.onset import matched_clearance
from validation.piece import Found, Piece
from validation.zeng2019.drawing.style import new_figure, style
from validation.zeng2019.figures.figure19 import CROSSINGS, SWEPT, crossings
from validation.zeng2019.models.mixed_frames import crossings_by_frame
from validation.zeng2019.models.other_casings import ODD_NODES, even_shapes_only, odd_nodes
from validation.zeng2019.runs.cases import SUPPORT_RPM, case, on_disk_support
from validation.zeng2019.runs.measures import harmonics
from validation.zeng2019.runs.outcome import Outcome, outcome_of, run_piece
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import AGREES, DIFFERS, EXPERIMENT, UNKNOWABLE, Statement, by_deviation, power

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STIFFNESS = 2e8
"""On this support the rub at 10,000 rev/min is period-1 with symmetric zones: orders can be told apart."""
PURE, MORE = 0.01, 1.1
"""Orders below this share are absent; a cause must change a share by this factor."""
ETA_C = (5, 9, 15)
"""Numbers of casing modes beside the paper's 11: circumferential orders up to 2, 4 and 7."""
FRAMES = Piece(crossings_by_frame, (SWEPT, SUPPORT_RPM))


def _scenario(size: Size) -> Scenario:
    return case(size, speed_rpm=SUPPORT_RPM, disk_support_stiffness_n_per_m=STIFFNESS)


def on_chords(smooth: Scenario, nodes: int) -> Scenario:
    """The scenario on chords between so many nodes that leave the tips the same air; its mesh stays as it is."""
    casing, machine = smooth.machine.casing, smooth.machine
    with_nodes = replace(machine, casing=replace(casing, nodes=nodes))
    clearance = matched_clearance(with_nodes, casing.clearance_m)
    matched = replace(machine, casing=replace(casing, clearance_m=clearance))
    return replace(smooth, machine=matched, contact=replace(smooth.contact, surface="chords"))


def _runs(size: Size) -> dict[str, Piece]:
    return {
        "as it is": on_disk_support(size, STIFFNESS),
        "even shapes only": Piece(even_shapes_only, (_scenario(size),)),
        "181 nodes": Piece(odd_nodes, (_scenario(size),)),
        "chords": run_piece(on_chords(_scenario(size), _scenario(size).machine.casing.nodes)),
        "chords, 181 nodes": Piece(odd_nodes, (on_chords(_scenario(size), ODD_NODES),)),
    }


def _other_modes(size: Size) -> dict[int, Piece]:
    return {count: run_piece(replace(_scenario(size), reduction=Reduction(casing_modes=count))) for count in ETA_C}


def pieces(size: Size) -> Sequence[Piece]:
    """Eight runs, one set of frequencies."""
    return [FRAMES, *_runs(size).values(), *_other_modes(size).values()]


def odd_share(amplitudes: np.ndarray) -> float:
    """Largest odd order over the largest even one."""
    even = float(amplitudes[1::2].max())
    return float(amplitudes[0::2].max()) / even if even > 0 else float("inf")


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """Odd orders at a point, the second crossing."""
    runs = {name: outcome_of(found(piece)) for name, piece in _runs(size).items()}
    modes = {count: outcome_of(found(piece)) for count, piece in _other_modes(size).items()}
    return [*_odd_orders(runs), _by_modes(modes), *_second_crossing(found)]


def _odd_orders(runs: dict[str, Outcome]) -> Sequence[Statement]:
    asked = {name: odd_share(harmonics(run.spectrum_casing)) for name, run in runs.items() if run.ok}
    force = {name: odd_share(run.force_orders) for name, run in runs.items() if run.ok}
    if len(asked) < len(runs):
        failed = ", ".join(f"{name}: {run.label}" for name, run in runs.items())
        return [Statement(statement="A point of the casing shows even orders.", verdict=UNKNOWABLE, found=failed)]
    plain, nodes = runs["as it is"], runs["181 nodes"]
    halves = odd_share(plain.even_field), 1 / max(odd_share(plain.odd_field), 1e-300)
    return [
        Statement(
            statement="A single point of the casing shows even orders only (period-1 rub at 2e8 N/m).",
            verdict=AGREES if asked["as it is"] < PURE else DIFFERS,
            found=f"largest odd over largest even order at the point {asked['as it is']:.3g}; of the half sum of "
            f"opposite points {halves[0]:.1g}; largest even over largest odd of their half difference {halves[1]:.1g}",
            why="The odd orders belong to the odd shapes (translation, three and five waves), the even orders to the "
            "even shapes.",
        ),
        Statement(
            statement="Without the casing's odd shapes the point shows even orders only.",
            verdict=AGREES if asked["even shapes only"] < PURE else DIFFERS,
            found=f"largest odd over largest even order {asked['even shapes only']:.1g}, of a motion that is "
            + runs["even shapes only"].label,
            apart=EXPERIMENT,
            why="The odd shapes are therefore the cause. The paper's casing, or its channel, has none.",
        ),
        Statement(
            statement="An odd number of casing nodes (181) causes these odd orders.",
            verdict=AGREES if asked["181 nodes"] > MORE * asked["as it is"] else DIFFERS,
            found=f"largest odd over largest even order at the point {asked['181 nodes']:.3g} with 181 nodes "
            f"({nodes.label}), {asked['as it is']:.3g} with 180",
            apart=EXPERIMENT,
            why="The undeformed surface is smooth with any number: only the deformed shape depends on the odd mesh.",
        ),
        Statement(
            statement="Chords between 181 nodes put odd orders into the contact force.",
            verdict=AGREES if force["chords, 181 nodes"] > MORE * max(force["chords"], force["as it is"]) else DIFFERS,
            found="largest odd over largest even order of the force: "
            + ", ".join(f"{name} {force[name]:.2g} ({runs[name].label})" for name in force),
            apart=EXPERIMENT,
            why="Chords have the air of the smooth curve: their clearance is larger by their inset. Where a run is not "
            "period-1, broken symmetry adds further odd orders.",
        ),
    ]


def _by_modes(runs: dict[int, Outcome]) -> Statement:
    shares = {count: odd_share(harmonics(run.spectrum_casing)) for count, run in runs.items() if run.ok}
    told = ", ".join(f"{share:.2g} with {count} ({runs[count].label})" for count, share in shares.items())
    gone = any(share < PURE for share in shares.values())
    return Statement(
        statement="Another number of casing modes than eta_c = 11 removes the odd orders from the point.",
        verdict=UNKNOWABLE if not shares else AGREES if gone else DIFFERS,
        found=f"largest odd over largest even order at the point: {told or 'every run diverged'}",
        apart=EXPERIMENT,
        why="The first five modes already contain the translation of the ring, an odd shape.",
    )


def _second_crossing(found: Found) -> Sequence[Statement]:
    lines = found(FRAMES)
    met = {name: crossings(lines["k"], lines[name], SUPPORT_RPM / 60) for name in ("consistent", "mixed", "halved")}
    told = {name: ", ".join(power(k) for k in values) or "none" for name, values in met.items()}
    made = [
        Statement(
            statement="Natural frequencies of a consistent model of the full blisk cross f_r once.",
            verdict=AGREES if len(met["consistent"]) == 1 else DIFFERS,
            found=f"at {told['consistent']} N/m",
            apart=EXPERIMENT,
        )
    ]
    for name, words in (
        ("mixed", "Blades in turning axes joined to a disk in inertial axes have"),
        ("halved", "The same with half the blades' Coriolis matrix has"),
    ):
        off = max((abs(k / c - 1) for k, c in zip(met[name], CROSSINGS, strict=False)), default=1.0)
        made.append(
            Statement(
                statement=f"{words} the paper's two crossings, 1.3e8 and 1.5e8 N/m.",
                verdict=by_deviation(off) if len(met[name]) == len(CROSSINGS) else DIFFERS,
                found=f"{len(met[name])} crossings, at {told[name]} N/m: off by up to {100 * off:.1f} %",
                why="The blades' Coriolis forces split the lateral frequency in two where only the blades' matrices "
                "are in turning axes; the paper writes disk matrices in inertial and blade matrices in turning axes.",
                apart=EXPERIMENT,
            )
        )
    return made


def figures(size: Size, found: Found) -> dict[str, Figure]:
    """Frequencies by frame, and orders at the point with and without odd shapes."""
    lines, runs = found(FRAMES), {name: outcome_of(found(piece)) for name, piece in _runs(size).items()}
    figure = new_figure(9.5, 3.0)
    left, right = figure.subplots(1, 2)
    for name, color in (("consistent", BLUE), ("mixed", ORANGE), ("halved", GREEN)):
        left.plot(lines["k"] / 1e8, lines[name], ".", color=color, markersize=2)
    left.axhline(SUPPORT_RPM / 60, color=VERMILION, linewidth=0.8)
    left.set_ylim(120, 220)
    style(left, "Disk support, 1e8 N/m", "Frequency, Hz", "consistent blue, mixed orange, halved green, $f_r$ red")
    for i, ((name, run), color) in enumerate(zip(runs.items(), (BLUE, ORANGE, GREEN), strict=False)):
        if run.ok:
            order = np.arange(1, 11) + 0.2 * (i - 1)
            top = np.maximum(harmonics(run.spectrum_casing), 1e-3)
            right.vlines(order, 1e-3, top, color=color, label=name, linewidth=3)
    right.set_yscale("log")
    right.set_ylim(1e-3, 1e5)
    right.legend(frameon=False, fontsize=7, ncols=3, loc="upper center")
    style(right, "Order at the casing's minor axis", "Acceleration, m/s²")
    return {"Left: frequencies of one nodal diameter by model; right: orders at a point with other casings": figure}


SECTION = Section(
    name="causes",
    title="Where physics and paper part: causes by experiment",
    text="Suspected differences are switched on and off at 10,000 rev/min. For the odd orders these are the shapes of "
    "the casing, its number of nodes, chords with the air of the smooth curve, and its number of modes eta_c. For the "
    "second crossing these are frames and the Coriolis matrix; the casing does not take part in it. The frame of the "
    "blisk's matrices does not matter for the odd orders: odd shapes respond at odd orders because of the symmetry of "
    "the casing.",
    pieces=pieces,
    statements=statements,
    figures=figures,
)
