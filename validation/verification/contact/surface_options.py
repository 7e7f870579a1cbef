"""The options of the contact surface: inner surface, chords, liner.

Inner surface: a tangential force on the casing with all of its modes is compared with the equilibrium of moments;
this is linear algebra, 1e-7. Chords: the comparison is plane geometry, exact to rounding. Liner: a Jeffcott rotor
in full annular rub wears its ring evenly. The normal force N(c) has a closed form. The depth w follows from dw/dt =
k N Omega c / (2 pi R b), c = R + w, solved by scipy. Force and slip are of first order in dt, so 1,024 and 2,048
steps a turn are extrapolated. At the foot of a moving contact, the surface recedes at the rate of its own wear
times int B^2 / h = 151 / 315, where B is the cubic spline of bins of width h. The work is taken between whole
steps. A bin spans 43 steps, so the error is about 1e-3.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.integrate import solve_ivp

from rubgen.contact import casing_surface
from rubgen.contact.geometry_kernels import casing_rows, undeformed_radius
from rubgen.contact.liner_kernels import REMOVED, WORK
from rubgen.fem.casing import assemble_casing
from rubgen.machine import Machine, load_machine
from rubgen.reduction.casing import reduce_casing
from rubgen.scenario import ContactLaw, Liner
from rubgen.solver.speed.start import closing_ramp, rub_free_stepper, start_opening
from validation.verification.rotors.jeffcott import CLEARANCE, FRICTION, SPEED, annular_rub, jeffcott_system
from validation.verification.row import Row, relative

TITLE = "Options of the contact surface"
NODES, NODE = 36, 7
LINER = Liner(thickness_m=1e-3, wear_m2_per_n=2e-14, width_m=0.02, bins=48)
STEPS, CLOSING, SETTLED, MEASURED = 1024, 40, 80, 40
SELF_OVERLAP = 151 / 315


def rows() -> Iterator[Row]:
    """Moments, chords, wear."""
    preset = load_machine("zeng2019")
    yield from _inner_surface(replace(preset, casing=replace(preset.casing, nodes=NODES, thickness_m=6e-3)))
    yield from _chords()
    yield from _wear()


def _inner_surface(machine: Machine) -> Iterator[Row]:
    modes, casing = 3 * NODES, machine.casing
    reduced, model = reduce_casing(machine, modes), assemble_casing(machine)
    system = replace(
        jeffcott_system(),
        n_casing=modes,
        casing_modes=reduced.modes_xy,
        casing_rotations=reduced.rotations,
        half_thickness=casing.thickness_m / 2,
    )
    rows_at, angle = np.zeros((2, modes)), 2 * np.pi * NODE / NODES
    casing_rows(casing_surface(system, ContactLaw(half_thickness=True)), angle + 1e-13, rows_at)
    q = rows_at.T @ [-np.sin(angle), np.cos(angle)] / (2 * np.pi * reduced.frequencies_hz) ** 2
    u, nodes = reduced.modes_xy @ q, model.nodes_xy
    moment = casing.circumferential_support_stiffness_n_per_m * nodes[:, 0] @ u[:, 1]
    moment -= casing.radial_support_stiffness_n_per_m * nodes[:, 1] @ u[:, 0]
    inner = float(np.hypot(*nodes[NODE])) - casing.thickness_m / 2
    yield relative("inner surface: moment of the springs for 1 N of friction, N m", "equilibrium", inner, moment, 1e-7)


def _chords() -> Iterator[Row]:
    system = jeffcott_system()
    surface, half = casing_surface(system, ContactLaw(surface="chords")), np.pi / len(system.casing_modes)
    middle, _, _ = undeformed_radius(surface, half)
    before, after = (undeformed_radius(surface, 2 * half + side * 1e-12)[1] for side in (-1, 1))
    source = "regular polygon"
    expected = CLEARANCE * np.cos(half)
    yield relative("chords: radius in the middle of a chord, m", source, expected, middle, 1e-13)
    turn = 2 * CLEARANCE * np.tan(half)
    yield relative("chords: jump of dr/dtheta at a node, m", source, turn, before - after, 1e-9)


def _wear() -> Iterator[Row]:
    coarse, fine = _worn(STEPS), _worn(2 * STEPS)
    start, gained = fine.start, 2 * fine.gained - coarse.gained
    track = 2 * np.pi * CLEARANCE * LINER.width_m

    def rate(_: float, w: np.ndarray) -> list[float]:
        c = CLEARANCE + w[0]
        return [LINER.wear_m2_per_n * annular_rub(c).force * SPEED * c / track]

    seconds = 2 * np.pi / SPEED * MEASURED
    exact = solve_ivp(rate, (0, seconds), [start], rtol=1e-10, atol=1e-15).y[0, -1] - start
    source = "Archard's law, quasi-static rub in closed form"
    yield relative(f"liner: depth worn in {MEASURED} turns, m", source, exact, gained, 2e-4)
    yield relative(
        "liner: volume in the profile, m3", "sum of the volumes removed by contacts", fine.removed, fine.volume, 1e-12
    )
    force = annular_rub(CLEARANCE + start + exact / 2).force
    expected = force * exact * LINER.bins * SELF_OVERLAP
    yield relative("liner: work on the receding surface, J", "151/315 of the wear of a bin", expected, fine.work, 5e-3)


@dataclass(frozen=True)
class _Worn:
    """Mean depth at the start of the measured turns and gained in them, m; volumes, m3; work on the surface, J."""

    start: float
    gained: float
    volume: float
    removed: float
    work: float


def _worn(steps: int) -> _Worn:
    system = jeffcott_system()
    stepper = rub_free_stepper(system, ContactLaw(friction=FRICTION, liner=LINER), steps, screen=False)
    opening, liner, wear = start_opening(system), stepper.model.surface.liner, stepper.state.wear
    for turn in range(SETTLED):
        stepper.run_turn(opening * closing_ramp((turn + np.arange(-1, steps + 1) / steps) / CLOSING))
    start, work = float(wear.depth.mean()), float(wear.sums[WORK])
    for _ in range(MEASURED):
        stepper.run_turn()
    return _Worn(
        start=start,
        gained=float(wear.depth.mean()) - start,
        volume=float(liner.area * wear.depth.sum()),
        removed=float(wear.sums[REMOVED]),
        work=float(wear.sums[WORK]) - work,
    )
