"""Faults that grow within a record, and a casing off centre.

A mass on springs under an unbalance that grows linearly has a closed form: in inertial axes m z'' + c z' + k z =
s(t) U Omega^2 e^(i Omega t), from rest in the whirl of the unbalance that is there from the start. The scheme's error
is (omega dt)^2 / 12 with 1,024 steps a turn. The onset of a rub is found to a turn.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rubgen.arrays import AnyArray, ComplexArray
from rubgen.contact.geometry import blade_tips, casing_surface
from rubgen.machine import load_machine
from rubgen.machine.faults.bow import Bow
from rubgen.machine.faults.casing_off_centre import CasingOffCentre
from rubgen.machine.faults.closing_clearance import ClosingClearance
from rubgen.machine.faults.growing_unbalance import GrowingUnbalance
from rubgen.pipeline import simulate
from rubgen.reduction import TurningForces, reduce
from rubgen.reduction.fault_loads import growing_loads
from rubgen.scenario import ContactLaw, Operation, Reduction, make_scenario
from rubgen.solver.integrate import integrate
from rubgen.solver.linear.rub_free import free_penetration, rub_free_motion
from rubgen.units import rad_per_s, rev_per_min
from validation.verification.rotors.rigid_rotor import rigid_rotor
from validation.verification.row import Row, relative, within

TITLE = "Faults that grow, and a casing off centre"
MASS, REST, RATIO, UNBALANCE, SPEED = 100.0, 200.0, 0.05, 1e-3, 300.0
STIFFNESS, DRAG = MASS * REST**2, 2 * RATIO * MASS * REST
TURNS = 40
TURN = 2 * np.pi / SPEED


def ramp_response(force: complex, time: AnyArray) -> ComplexArray:
    """Answer of the mass, at rest before, to force t e^(i Omega t) from t = 0 on (force in N/s): z e^(-i Omega t)."""
    s = 1j * SPEED
    D, slope = MASS * s**2 + DRAG * s + STIFFNESS, 2 * MASS * s + DRAG
    rate, swing = -RATIO * REST, REST * np.sqrt(1 - RATIO**2)
    roots = np.array([complex(rate, swing), complex(rate, -swing)])
    start = -force * slope / D**2  # of the forced part, whose derivative at 0 is force / D + s start
    free = np.linalg.solve(np.array([[1, 1], roots]), -np.array([start, force / D + s * start]))
    t = np.maximum(time, 0.0)
    own = np.exp(np.multiply.outer(t, roots)) @ free
    whole = (force * t / D + start) * np.exp(s * t) + own
    return np.asarray(np.where(time > 0, whole * np.exp(-s * t), 0.0))


def linear_growth(fault: Bow | GrowingUnbalance, start: float, duration: float, full: complex) -> tuple[float, float]:
    """Largest difference of a run from the closed form, and the largest motion that the growth makes, in m."""
    machine = replace(load_machine("zeng2019"), faults=(fault,))
    support = replace(machine.disk_support, lateral_stiffness_n_per_m=STIFFNESS)
    growing = growing_loads(replace(machine, disk_support=support), SPEED)
    system = rigid_rotor(
        SPEED, mass=MASS, stiffness=STIFFNESS, damping=DRAG, unbalance=UNBALANCE, forces=TurningForces(growing=growing)
    )
    operation = Operation(speed_rpm=rev_per_min(SPEED), settle_turns=5, record_turns=TURNS, closing_turns=2)
    response = integrate(system, operation, ContactLaw())
    steps = TURNS * response.steps_per_turn
    time = np.arange(steps) * response.dt
    place = (response.taps["blisk_x"] + 1j * response.taps["blisk_y"])[-steps:] * np.exp(-1j * SPEED * time)
    rest = UNBALANCE * SPEED**2 / complex(STIFFNESS - MASS * SPEED**2, DRAG * SPEED)
    growth = full / duration
    turn = np.exp(1j * SPEED * np.array([start, start + duration]))
    moved = sum(
        sign * ramp_response(growth * at, time - begin) * np.conj(at)
        for sign, at, begin in zip((1, -1), turn, (start, start + duration), strict=True)
    )
    return float(np.abs(place - rest - moved).max()), float(np.abs(moved).max())


def growth_rows() -> Iterator[Row]:
    """An unbalance and a bow that grow over ten turns and over one."""
    source = "m z'' + c z' + k z = s(t) F e^(i Omega t) in closed form"
    for turns in (10, 1):
        start, duration = 5 * TURN, turns * TURN
        unbalance = GrowingUnbalance(kg_m=2e-3, angle_deg=60.0, start_s=start, growth_s=duration)
        bow = Bow(bow_m=2e-5, angle_deg=-40.0, start_s=start, growth_s=duration)
        for name, fault, full in (
            ("unbalance", unbalance, 2e-3 * SPEED**2 * np.exp(1j * np.deg2rad(60.0))),
            ("bow", bow, 2e-5 * STIFFNESS * np.exp(-1j * np.deg2rad(40.0))),
        ):
            error, size = linear_growth(fault, start, duration, full)
            quantity = f"{name} that grows within {duration:.3f} s: largest error of the whirl over its growth"
            yield within(quantity, source, 0.0, error / size, 2e-4)


def penetration(fault: CasingOffCentre | None, ovality: float) -> float:
    """Free penetration of the preset at 8,600 rev/min, m."""
    machine = load_machine("zeng2019")
    casing = replace(machine.casing, ovality_m=ovality)
    machine = replace(machine, casing=casing, faults=() if fault is None else (fault,))
    system = reduce(machine, Reduction()).at_speed(rad_per_s(8600.0))
    return free_penetration(rub_free_motion(system), casing_surface(system, ContactLaw()), blade_tips(system))


def off_centre_rows() -> Iterator[Row]:
    """The gap closes by the offset: in a circle on the side opposite to it, in the oval also along its narrow axis."""
    for direction, ovality in ((30.0, 0.0), (180.0, 8e-3)):
        fault = CasingOffCentre(offset_m=1e-4, direction_deg=direction)
        closed = penetration(fault, ovality) - penetration(None, ovality)
        shape = "oval" if ovality else "circle"
        yield relative(f"casing off centre by 0.1 mm, {shape}: closing of the gap, m", "the offset", 1e-4, closed, 1e-4)


def onset_rows() -> Iterator[Row]:
    """A clearance that closes at a constant speed: the time of the first touch."""
    closing, start, growth = 1e-3, 0.5, 2.0
    scenario = make_scenario(speed_rpm=9000, clearance_m=1.2e-3, lyapunov=False, signal_seconds=0.2)
    fault = ClosingClearance(closing_m=closing, start_s=start, growth_s=growth)
    response = simulate(replace(scenario, machine=replace(scenario.machine, faults=(fault,)))).response
    expected = start + growth * -response.free_penetration / closing
    found = float(response.events.start_step.min() * response.dt)
    source = "start + growth (smallest gap / closing), to a turn"
    yield within("clearance that closes: first touch, s", source, expected, found, 60 / 9000)


def rows() -> Iterator[Row]:
    """Growth of unbalance and bow, a casing off centre, a clearance that closes."""
    yield from growth_rows()
    yield from off_centre_rows()
    yield from onset_rows()
