"""What is allowed but surely not meant: values that the machine's own sizes speak against, one line each.

Each check yields "key = value: why; was ... meant?". A question names the unit in which the value would fit, and is
left out where none would. Limits are far outside of what machines are like, and far inside of what can be computed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from rubgen.errors import warn
from rubgen.machine import Machine
from rubgen.machine.mass import blisk_mass
from rubgen.scenario.costs import steps_per_turn
from rubgen.scenario.scenario import Scenario

MOST_CLEARANCE = 0.02
MOST_OVALITY = 0.05
MOST_THICKNESS = 0.1
"""Shares of the radius: clearance and ovality of the tips', thickness of the casing's."""
MOST_ECCENTRICITY = 0.01
"""Share of the tip radius by which an unbalance moves the centre of mass."""
MODULI_PA = (1e9, 1.3e12)
"""From plastics to diamond."""
DENSITIES = (500.0, 23_000.0)
"""From foam to osmium, in kg/m3."""
MOST_TIP_SPEED = 1000.0
"""Twice what turbomachines reach, in m/s."""
LEAST_ORDERS = 2.56
"""Samples a turn below which a channel does not show the rotation."""
MOST_STEP_FACTOR = 16
LEAST_SHARE = 5e-3
"""A value is asked about in mm where it would be no smaller than this share of the largest plausible one."""
LEAST_GRAM_MILLIMETRES = 10
MOST_GRAVITY = 20.0
RADIANS = math.pi / 2


def warn_of(scenarios: Iterable[Scenario], source: str = "") -> None:
    """Warn of each implausible key once, with the first of the scenarios in which it is so."""
    found: dict[str, str] = {}
    for scenario in scenarios:
        for text in implausible(scenario):
            found.setdefault(text.partition(" = ")[0], text)
    for text in found.values():
        warn(f"{source}{text}")


def implausible(scenario: Scenario) -> Iterator[str]:
    """Every value of a scenario that is surely not meant."""
    for check in CHECKS:
        yield from check(scenario)


def _casing(scenario: Scenario) -> Iterator[str]:
    machine, casing = scenario.machine, scenario.machine.casing
    radius, mean = machine.tip_radius_m, machine.casing_mean_radius_m
    for key, value, most, whole, of in (
        ("clearance_m", casing.clearance_m, MOST_CLEARANCE, radius, "the radius of the blade tips"),
        ("ovality_m", casing.ovality_m, MOST_OVALITY, radius, "the radius of the blade tips"),
        ("casing_thickness_m", casing.thickness_m, MOST_THICKNESS, mean, "the casing's radius, a thin ring has less"),
    ):
        if value > most * whole:
            yield f"{key} = {value:g}: {100 * value / whole:.3g} % of {of}{millimetres(value, most * whole)}"


def _sizes(scenario: Scenario) -> Iterator[str]:
    disk, blades, casing = scenario.machine.disk, scenario.machine.blades, scenario.machine.casing
    rim, tip = disk.rim_radius_m, scenario.machine.tip_radius_m
    for key, value, limit, what in (
        ("disk.bore_thickness_m", disk.bore_thickness_m, 2 * rim, "the disk's diameter"),
        ("disk.rim_thickness_m", disk.rim_thickness_m, 2 * rim, "the disk's diameter"),
        ("blades.length_m", blades.length_m, 10 * rim, "ten times the rim's radius"),
        ("blades.root_chord_m", blades.root_chord_m, 2 * tip, "the diameter of the tips"),
        ("blades.tip_chord_m", blades.tip_chord_m, 2 * tip, "the diameter of the tips"),
        ("blades.root_thickness_m", blades.root_thickness_m, blades.root_chord_m, "the chord there"),
        ("blades.tip_thickness_m", blades.tip_thickness_m, blades.tip_chord_m, "the chord there"),
        ("casing.width_m", casing.width_m, 10 * tip, "ten times the radius of the tips"),
    ):
        if value > limit:
            yield f"{key} = {value:g}: larger than {what}, {limit:g} m{millimetres(value, limit)}"


def _materials(scenario: Scenario) -> Iterator[str]:
    machine = scenario.machine
    for part, material in (
        ("disk", machine.disk.material),
        ("blades", machine.blades.material),
        ("casing", machine.casing.material),
    ):
        modulus, density = material.youngs_modulus_pa, material.density_kg_per_m3
        if not MODULI_PA[0] <= modulus <= MODULI_PA[1]:
            question = _question(modulus, MODULI_PA, {"GPa": 1e9, "MPa": 1e6, "kPa": 1e3}, "Pa")
            yield f"{part}.material.youngs_modulus_pa = {modulus:g}: no solid of a machine has it{question}"
        if not DENSITIES[0] <= density <= DENSITIES[1]:
            question = _question(density, DENSITIES, {"g/cm3": 1e3, "t/mm3": 1e12}, "kg/m3")
            yield f"{part}.material.density_kg_per_m3 = {density:g}: no solid of a machine has it{question}"
        if material.poisson_ratio < 0:
            yield f"{part}.material.poisson_ratio = {material.poisson_ratio:g}: metals have 0.25 to 0.35"


def _unbalance(scenario: Scenario) -> Iterator[str]:
    machine = scenario.machine
    every = [("unbalance_kg_m", machine.unbalance_kg_m)]
    every += [(f"unbalances.{number}.kg_m", each.kg_m) for number, each in enumerate(machine.unbalances)]
    for key, value in every:
        away = eccentricity(machine, value)
        if away > MOST_ECCENTRICITY * machine.tip_radius_m:
            yield f"{key} = {value:g}: moves the centre of mass of the blisk {away:.3g} m off the axis{gram(value)}"


def _speed(scenario: Scenario) -> Iterator[str]:
    operation = scenario.operation
    fastest = max(operation.speed_rpm, operation.end_speed_rpm or 0.0)
    tips = operation.rotation.fastest * scenario.machine.tip_radius_m
    if tips > MOST_TIP_SPEED:
        key = "speed_rpm" if fastest == operation.speed_rpm else "end_speed_rpm"
        yield f"{key} = {fastest:g}: the blade tips move at {tips:.3g} m/s, more than {MOST_TIP_SPEED:g}"


def _rate(scenario: Scenario) -> Iterator[str]:
    rate = scenario.sensing.sample_rate_hz
    turn = scenario.operation.rotation.fastest / (2 * math.pi)
    if rate < LEAST_ORDERS * turn:
        fits = LEAST_ORDERS * turn <= 1e3 * rate <= 1e6
        question = f"; were kHz meant, {1e3 * rate:g} Hz?" if fits else ""
        yield f"sample_rate_hz = {rate:g}: no channel shows the rotation, which has up to {turn:.4g} Hz{question}"
    least = scenario.operation.steps_per_turn
    factor = steps_per_turn(scenario) // least
    if factor >= MOST_STEP_FACTOR:
        which, fed = "sample_rate_hz", rate
        if scenario.sensing.set.front_end_hz > rate:
            which, fed = "sensors.set: bandwidth_hz or resonance_hz", scenario.sensing.set.front_end_hz
        steps = f"{factor * least:,} steps a turn instead of {least:,}"
        yield f"{which} = {fed:g}: needs {steps}, a run takes up to {factor} times as long"


def _gravity(scenario: Scenario) -> Iterator[str]:
    g = scenario.machine.gravity_m_per_s2
    if g > MOST_GRAVITY:
        question = f"; were mm/s2 meant, {g / 1000:g} m/s2?" if g / 1000 <= MOST_GRAVITY else ""
        yield f"gravity_m_per_s2 = {g:g}: the earth has 9.81{question}"


def _angles(scenario: Scenario) -> Iterator[str]:
    blades = scenario.machine.blades
    root, tip = blades.root_angle_deg, blades.tip_angle_deg
    if 0 < max(abs(root), abs(tip)) <= RADIANS and root and tip:
        meant = f"were rad meant, {math.degrees(root):.4g} and {math.degrees(tip):.4g} degrees?"
        yield f"blades.root_angle_deg = {root:g}: it and the tip's, {tip:g}, are below 2 degrees; {meant}"
    places = [("unbalance_angle_deg", scenario.machine.unbalance_angle_deg)]
    places += [("casing.lobe_angle_deg", scenario.machine.casing.lobe_angle_deg)]
    for sensor in scenario.sensing.set.sensors:
        places.append((f"angle_deg of {sensor.name}", getattr(sensor, "angle_deg", 0.0)))
    for key, angle in places:
        quarters = round(angle / RADIANS)
        if 1 <= quarters <= 4 and abs(angle - quarters * RADIANS) < 0.004 * quarters:
            yield f"{key} = {angle:g}: {quarters} pi / 2; were rad meant, {90 * quarters} degrees?"


CHECKS = (_casing, _sizes, _materials, _unbalance, _speed, _rate, _gravity, _angles)


def eccentricity(machine: Machine, unbalance: float) -> float:
    """How far an unbalance (kg m) moves the centre of mass of the blisk from the axis, in m."""
    return unbalance / blisk_mass(machine)


def gram(unbalance: float) -> str:
    """The question whether an unbalance was given in g mm."""
    return f"; were g mm meant, {unbalance * 1e-6:g} kg m?" if unbalance >= LEAST_GRAM_MILLIMETRES else ""


def millimetres(value: float, most: float) -> str:
    """The question whether a length was given in mm, where it would fit."""
    fits = LEAST_SHARE * most <= value / 1000 <= most
    return f"; were mm meant, {value / 1000:g} m?" if fits else ""


def _question(value: float, allowed: tuple[float, float], units: dict[str, float], ours: str) -> str:
    """The first unit in which the value would be allowed, as a question."""
    for unit, factor in units.items():
        if allowed[0] <= value * factor <= allowed[1]:
            return f"; were {unit} meant, {value * factor:g} {ours}?"
    return ""
