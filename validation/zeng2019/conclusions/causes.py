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
from validation.zeng2019.figures.figure17 import TRIP
from validation.zeng2019.figures.figure19 import CROSSINGS, SWEPT, crossings
from validation.zeng2019.meanings import FRAMES_MIXED, SYMMETRY
from validation.zeng2019.models.mixed_frames import MODELS, crossings_by_frame, points_by_frame
from validation.zeng2019.models.other_casings import ODD_NODES, even_shapes_only, odd_nodes
from validation.zeng2019.runs.cases import SUPPORT_RPM, at_speed, case, on_disk_support
from validation.zeng2019.runs.measures import harmonics
from validation.zeng2019.runs.outcome import Outcome, outcome_of, run_piece
from validation.zeng2019.section import Section
from validation.zeng2019.size import AS_COMPUTED, TWIN, Size
from validation.zeng2019.statement import AGREES, DIFFERS, EXPERIMENT, UNKNOWABLE, Statement, by_deviation, power

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STIFFNESS = 2e8
"""On this support the rub at 10,000 rev/min is period-1 with symmetric zones: orders can be told apart."""
PURE, MORE = 0.01, 1.1
"""Orders below this share are absent; a cause must change a share by this factor."""
ETA_C = (5, 9, 15)
"""Numbers of casing modes beside the paper's 11: circumferential orders up to 2, 4 and 7."""
CALM_RPM = 12300.0
"""Rev/min at which both surfaces have period-1 motion with the machine's own air."""
AS_IT_IS, EVEN, ODD = "as it is", "even shapes only", f"{ODD_NODES} nodes"
SMOOTH, CHORDS, ODD_CHORDS = "smooth", "chords", f"chords, {ODD_NODES} nodes"
FRAMES = Piece(crossings_by_frame, (SWEPT, SUPPORT_RPM))
FINE = [8e7 + 1e6 * i for i in range(171)]
POINTS = Piece(points_by_frame, (FINE, SUPPORT_RPM))


def _scenario(size: Size) -> Scenario:
    return case(size, speed_rpm=SUPPORT_RPM, disk_support_stiffness_n_per_m=STIFFNESS)


def _smooth(size: Size) -> Scenario:
    """The same on the smooth curve, with the same air."""
    return _scenario(replace(size, machine=TWIN) if size.machine == AS_COMPUTED else size)


def on_chords(smooth: Scenario, nodes: int) -> Scenario:
    """The scenario on chords between so many nodes that leave the tips the same air; its mesh stays as it is."""
    casing, machine = smooth.machine.casing, smooth.machine
    with_nodes = replace(machine, casing=replace(casing, nodes=nodes))
    clearance = matched_clearance(with_nodes, casing.clearance_m)
    matched = replace(machine, casing=replace(casing, clearance_m=clearance))
    return replace(smooth, machine=matched, contact=replace(smooth.contact, surface="chords"))


def _runs(size: Size) -> dict[str, Piece]:
    odd = on_chords(_smooth(size), ODD_NODES) if size.machine == AS_COMPUTED else _scenario(size)
    return {
        AS_IT_IS: on_disk_support(size, STIFFNESS),
        EVEN: Piece(even_shapes_only, (_scenario(size),)),
        ODD: Piece(odd_nodes, (odd,)),
    }


def _on_both_surfaces(size: Size) -> dict[str, Piece]:
    smooth = replace(size, machine=TWIN) if size.machine == AS_COMPUTED else size
    calm = case(smooth, speed_rpm=CALM_RPM)
    chords = run_piece(on_chords(calm, calm.machine.casing.nodes))
    return {
        SMOOTH: at_speed(smooth, CALM_RPM),
        CHORDS: at_speed(size, CALM_RPM) if size.machine == AS_COMPUTED else chords,
        ODD_CHORDS: Piece(odd_nodes, (on_chords(calm, ODD_NODES),)),
    }


def _other_modes(size: Size) -> dict[int, Piece]:
    return {count: run_piece(replace(_scenario(size), reduction=Reduction(casing_modes=count))) for count in ETA_C}


def pieces(size: Size) -> Sequence[Piece]:
    """Nine runs, and two sets of lines by model; the twin takes no part."""
    if size.machine == TWIN:
        return []
    runs = (_runs(size), _on_both_surfaces(size), _other_modes(size))
    return [FRAMES, POINTS, *(piece for made in runs for piece in made.values())]


def odd_share(amplitudes: np.ndarray) -> float:
    """Largest odd order over the largest even one."""
    even = float(amplitudes[1::2].max())
    return float(amplitudes[0::2].max()) / even if even > 0 else float("inf")


def statements(size: Size, found: Found) -> Sequence[Statement]:
    """Odd orders at a point, the second crossing."""
    if size.machine == TWIN:
        return []
    runs, surfaces = (
        {name: outcome_of(found(piece)) for name, piece in made.items()}
        for made in (_runs(size), _on_both_surfaces(size))
    )
    modes = {count: outcome_of(found(piece)) for count, piece in _other_modes(size).items()}
    return [*_odd_orders(runs), _odd_chords(surfaces), _by_modes(modes), *_second_crossing(found), _jumps(found)]


def _odd_orders(runs: dict[str, Outcome]) -> Sequence[Statement]:
    asked = {name: odd_share(harmonics(run.spectrum_casing)) for name, run in runs.items() if run.ok}
    if len(asked) < len(runs):
        failed = ", ".join(f"{name}: {run.label}" for name, run in runs.items())
        return [Statement(statement="A point of the casing shows even orders.", verdict=UNKNOWABLE, found=failed)]
    plain = runs[AS_IT_IS]
    halves = odd_share(plain.even_field), 1 / max(odd_share(plain.odd_field), 1e-300)
    return [
        Statement(
            statement="A single point of the casing shows even orders only (period-1 rub at 2e8 N/m).",
            verdict=AGREES if asked[AS_IT_IS] < PURE else DIFFERS,
            found=f"largest odd over largest even order at the point {asked[AS_IT_IS]:.3g} ({plain.label}); of the "
            f"half sum of opposite points {halves[0]:.1g}; largest even over largest odd of their half difference "
            f"{halves[1]:.1g}",
            why="The odd orders belong to the odd shapes (translation, three and five waves), the even orders to the "
            "even shapes.",
        ),
        Statement(
            statement="Without the casing's odd shapes the point shows even orders only.",
            verdict=AGREES if asked[EVEN] < PURE else DIFFERS,
            found=f"largest odd over largest even order {asked[EVEN]:.1g}, of a motion that is {runs[EVEN].label}",
            apart=EXPERIMENT,
            why="The odd shapes are therefore the cause.",
            about=("ven orders", "casing's vibration is f_r times"),
            cause=SYMMETRY,
        ),
        Statement(
            statement="An odd number of casing nodes (181) causes these odd orders.",
            verdict=AGREES if asked[ODD] > MORE * asked[AS_IT_IS] else DIFFERS,
            found=f"largest odd over largest even order at the point {asked[ODD]:.3g} with 181 nodes "
            f"({runs[ODD].label}), {asked[AS_IT_IS]:.3g} with 180",
            apart=EXPERIMENT,
            why="The undeformed surface is smooth with any number: only the deformed shape depends on the odd mesh.",
        ),
    ]


def _odd_chords(runs: dict[str, Outcome]) -> Statement:
    force = {name: odd_share(run.force_orders) for name, run in runs.items() if run.ok}
    compared = [force[name] for name in (SMOOTH, CHORDS) if name in force and runs[name].regular]
    asked = ODD_CHORDS in force and len(compared) == len(runs) - 1
    return Statement(
        statement="Chords between 181 nodes put odd orders into the contact force.",
        verdict=UNKNOWABLE if not asked else AGREES if force[ODD_CHORDS] > MORE * max(compared) else DIFFERS,
        found=f"largest odd over largest even order of the force at {CALM_RPM:,.0f} rev/min: "
        + ", ".join(f"{name} {force[name]:.2g} ({runs[name].label})" for name in force),
        apart=EXPERIMENT,
        why="Chords have the air of the smooth curve: their clearance is larger by their inset.",
    )


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
    met = {name: crossings(lines["k"], lines[name], SUPPORT_RPM / 60) for name in MODELS}
    told = {name: ", ".join(power(k) for k in values) or "none" for name, values in met.items()}
    made = [
        Statement(
            statement="Natural frequencies of a consistent model of the full blisk cross f_r once.",
            verdict=AGREES if len(met["consistent"]) == 1 else DIFFERS,
            found=f"at {told['consistent']} N/m",
            apart=EXPERIMENT,
            about=("Another natural frequency",),
            cause=FRAMES_MIXED,
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


def _jumps(found: Found) -> Statement:
    """Where x of the disk centre once a turn changes fastest without rub, by model."""
    lines = found(POINTS)
    k = (lines["k"][1:] + lines["k"][:-1]) / 2
    at = {name: float(k[np.argmax(np.abs(np.diff(lines[name])))]) for name in MODELS}
    return Statement(
        statement="In the last of these models the point of each turn jumps at 1.4e8 N/m.",
        verdict=by_deviation(at["halved"] / TRIP - 1),
        found="x of the disk centre once a turn, without rub, changes fastest at "
        + ", ".join(f"{power(at[name])} N/m ({name})" for name in MODELS),
        why="A consistent model has its jump near its one crossing, and so have the runs of figure 17.",
        apart=EXPERIMENT,
        about=("one stiffness, 1.4e8",),
        cause=FRAMES_MIXED,
    )


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
    "the casing, its number of nodes and its number of modes eta_c. Chords between an odd number of nodes are tried at "
    "12,300 rev/min, where both surfaces have period-1 motion. For the second crossing and for the jump these are "
    "frames and the Coriolis matrix; the casing does not take part in them. The frame of the blisk's matrices does not "
    "matter for the odd orders: odd shapes respond at odd orders because of the symmetry of the casing.",
    pieces=pieces,
    statements=statements,
    figures=figures,
    compared=True,
)
