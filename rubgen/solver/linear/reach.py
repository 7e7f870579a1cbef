"""Find out whether a blade can reach the casing at all, from the rub-free motions before any run."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rubgen.contact.geometry import blade_tips, casing_surface
from rubgen.errors import UserError
from rubgen.reduction import ReducedModel, reduce
from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import Scenario
from rubgen.scenario.checks.plausible import MOST_TIP_SPEED
from rubgen.solver.linear.admissible import check_system
from rubgen.solver.linear.rub_free import free_penetration, rub_free_motion
from rubgen.units import rad_per_s, rev_per_min

LEAST_CLEARANCE_M = 1e-7
"""The least clearance that a machine may have."""
SPEEDS = 9
"""Number of speeds at which a changing speed is checked, first and last included."""


def no_rub_warning(scenarios: Sequence[Scenario]) -> str | None:
    """Return a warning of one line if no blade reaches the casing in the rub-free motion of any run, else None.

    A run starts from its rub-free motion and keeps it where nothing touches. Where `deepest` is infinite a rub is
    possible. Runs that are refused are left out; None if all are refused. A single run without rub may be intended. It
    has the warning only if it would rub if its speed had been given in rad/s by mistake.
    """
    largest, at, looked_at = -math.inf, 0.0, 0
    for scenario in scenarios:
        try:
            depth, speed = deepest(scenario)
        except (UserError, np.linalg.LinAlgError):
            continue
        if depth >= 0:
            return None
        looked_at += 1
        if depth > largest:
            largest, at = depth, speed
    if not looked_at:
        return None
    question = _question(scenarios)
    if len(scenarios) == 1 and not question:
        return None
    which = "this run" if len(scenarios) == 1 else f"any of the {looked_at} runs looked at"
    return (
        f"no blade can reach the casing in {which}: the largest free penetration is {1e3 * largest:.3g} mm, at "
        f"{at:.6g} rev/min{question}"
    )


def with_clearance(scenario: Scenario) -> Scenario:
    """Return the scenario with the clearance that follows from its `free_penetration_m`, which becomes None.

    Without a `free_penetration_m` the scenario is unchanged. A larger clearance moves the undeformed surface outward
    and leaves the rub-free motion as it is. One correction is therefore exact except for rounding, at the speed of the
    run and at the beginning of its record. For a changing speed, the largest penetration of nine steady speeds counts
    (`deepest`). Laws whose motion must settle are left out. Raises UserError where the clearance would be below the
    least allowed, 0.1 um.
    """
    wanted, casing = scenario.free_penetration_m, scenario.machine.casing
    if wanted is None:
        return scenario
    model = reduce(scenario.machine, scenario.reduction)
    depths = []
    for speed in _speeds(scenario):
        system = model.at_speed(speed)
        surface, tips = casing_surface(system, scenario.contact), blade_tips(system)
        depths.append((free_penetration(rub_free_motion(system), surface, tips), speed))
    depth, at = max(depths)
    clearance = casing.clearance_m + depth - wanted
    if clearance < LEAST_CLEARANCE_M:
        most = casing.clearance_m + depth - LEAST_CLEARANCE_M
        raise UserError(
            f"free_penetration_m = {wanted:.6g}: at {rev_per_min(at):g} rev/min it needs a clearance of "
            f"{clearance:.3g} m at rest; lower it to at most {most:.4g}"
        )
    machine = replace(scenario.machine, casing=replace(casing, clearance_m=clearance))
    return replace(scenario, machine=machine, free_penetration_m=None)


def deepest(scenario: Scenario) -> tuple[float, float]:
    """Return the largest free penetration of a run in m, and its speed in rev/min. A negative penetration is a gap.

    A changing speed is checked at nine speeds from the slowest to the fastest, each as a steady speed. The amplitude of
    a run through a critical speed is smaller. The penetration is infinite where only the run shows it, as in
    `penetration_at`. The clearance is that of `with_clearance`. Raises UserError as `with_clearance` and `reduce` do,
    and where the system cannot be integrated at a speed.
    """
    scenario = with_clearance(scenario)
    model = reduce(scenario.machine, scenario.reduction)
    return max((penetration_at(model, scenario, speed), rev_per_min(speed)) for speed in _speeds(scenario))


def penetration_at(model: ReducedModel, scenario: Scenario, speed: float) -> float:
    """Return the free penetration at a speed in rad/s: how deep tips enter the undeformed casing without contact, in m.

    It is infinite where the motion without rub is not known because of laws of the support. It is also infinite where a
    gap at the beginning of the record may be used up later, by a load that grows or a clearance that closes. `model` is
    the reduced machine of `scenario`, with its clearance. `free_penetration_m` is not read. Raises UserError where the
    system cannot be integrated at this speed.
    """
    system = model.at_speed(speed)
    depth = _first_penetration(system, scenario)
    closing = sum(each.amount_m for each in system.narrowings)
    grows = system.turning is not None and bool(system.turning.growing)
    return math.inf if depth < 0 and (grows or depth + closing >= 0) else depth


def onset_clearance(model: ReducedModel, scenario: Scenario, speeds: Sequence[float]) -> float:
    """Return the clearance in m at which the blades just reach the casing at the worst of some speeds in rad/s.

    It is the machine's clearance plus the largest free penetration at the beginning of the record: what grows or closes
    later does not count. It is infinite where laws of the support leave the motion without rub unknown. Raises
    UserError where the system cannot be integrated at a speed.
    """
    deepest = max(_first_penetration(model.at_speed(speed), scenario) for speed in speeds)
    return scenario.machine.casing.clearance_m + deepest


def _first_penetration(system: SpinningSystem, scenario: Scenario) -> float:
    """Return the free penetration at the beginning of the record, m; infinite where it is not known."""
    check_system(system)
    if system.starting is not system:
        return math.inf
    surface, tips = casing_surface(system, scenario.contact), blade_tips(system)
    return free_penetration(rub_free_motion(system), surface, tips)


def _speeds(scenario: Scenario) -> list[float]:
    """Return the speed of a run in rad/s, or nine from its slowest to its fastest."""
    rotation = scenario.operation.rotation
    if rotation.is_steady:
        return [rotation.start]
    return [float(speed) for speed in np.linspace(rotation.slowest, rotation.fastest, SPEEDS)]


def _question(scenarios: Sequence[Scenario]) -> str:
    """Return a question whether speeds were meant in rad/s, where a blade would then reach the casing."""
    fastest = max(scenarios, key=lambda each: each.operation.speed_rpm)
    rpm = rev_per_min(fastest.operation.speed_rpm)
    drawn_depth = fastest.free_penetration_m is not None
    if drawn_depth or fastest.operation.speed_rpm * fastest.machine.tip_radius_m > MOST_TIP_SPEED:
        return ""
    try:
        model = reduce(fastest.machine, fastest.reduction)
        reaches = penetration_at(model, fastest, rad_per_s(rpm)) >= 0
    except (UserError, np.linalg.LinAlgError):
        return ""
    given = f"{fastest.operation.speed_rpm:.6g} rad/s are {rpm:.6g} rev/min"
    return f"; were rad/s meant? A blade would: {given}" if reaches else ""
