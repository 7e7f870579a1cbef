"""Find values that are allowed but hardly intended, from the machine's own sizes, in one line each.

Each check yields "key = value: why; was ... meant?". A question names the unit in which the value would fit, and is
left out where none would. The limits are far outside of real machines, and far inside of what can be computed.
"""

import math
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from rubgen.errors import warn
from rubgen.machine import Machine
from rubgen.machine.mass import blisk_mass
from rubgen.machine.quantities import Place, usual_values
from rubgen.machine.schema_nodes import digits
from rubgen.scenario.checks.idle import idle
from rubgen.scenario.costs import steps_per_turn
from rubgen.scenario.scenario import Scenario
from rubgen.scenario.vary import KEYS_AT
from rubgen.sensors.kinds.blade_tip_timing import TimingProbe
from rubgen.sensors.kinds.once_per_rev import OncePerRev

MOST_ECCENTRICITY = 0.01
"""Largest plausible eccentricity of an unbalance as a share of the tip radius."""
MOST_TIP_SPEED = 1000.0
"""Twice the tip speed of turbomachines, in m/s."""
LEAST_ORDERS = 2.56
"""Samples a turn below which a channel does not show the rotation."""
MOST_STEP_FACTOR = 16
LEAST_SHARE = 5e-3
"""A question about mm or um is asked where the value would then be at least this share of the largest plausible one."""
LENGTHS = (("mm", 1e-3), ("um", 1e-6))
LEAST_HZ = 1.0
"""Softer supports cannot carry a machine."""
STIFFNESSES = (("N/mm", 1e3), ("N/um", 1e6), ("GN/m", 1e9))
SUPPORTED_HZ = (10.0, 10_000.0)
"""A question about a stiffness names the first unit in which the supported body has a frequency in this range."""
COUNTS_A_PASSAGE = 20
"""A clock with fewer counts between two blades does not show their vibration."""
MOST_DROPPED = 0.5
LEAST_GRAM_MILLIMETRES = 10
RADIANS = math.pi / 2
_QUARTERS = ("", "pi / 2", "pi", "3 pi / 2", "2 pi")


def warn_of(scenarios: Iterable[Scenario], source: str = "") -> None:
    """Warn once of each key with an implausible value. `source` is the beginning of the warning with its ": ".

    The warning shows the value of the first scenario in which the key is implausible. A key that changes no channel is
    named only if it changes no channel in all of the scenarios.
    """
    checked = list(scenarios)
    found: dict[str, str] = {}
    for scenario in checked:
        for text in implausible(scenario):
            found.setdefault(text.partition(" = ")[0], text)
    found |= idle(checked)
    for text in found.values():
        warn(f"{source}{text}")


def implausible(scenario: Scenario) -> Iterator[str]:
    """Yield a line "key = value: why" for every value of a scenario that is allowed but hardly intended."""
    for check in CHECKS:
        yield from check(scenario)


def _usual(scenario: Scenario) -> Iterator[str]:
    for place, value, usual in usual_values(scenario):
        doubt = usual.doubt(value)
        if doubt:
            yield f"{_key(scenario, place)} = {value:g}: {doubt}"


def _faults(scenario: Scenario) -> Iterator[str]:
    for fault in scenario.machine.faults:
        doubt = fault.doubt(scenario.machine, scenario.operation.speed_rad_per_s)
        if doubt:
            yield doubt


def _key(scenario: Scenario, place: Place) -> str:
    """Return the key of a place of the scenario, as in a recipe, a machine or a sensor set."""
    match place:
        case ("sensing", "set", "sensors", int(number), key, *_):
            return f"{key} of {scenario.sensing.set.sensors[number].name}"
        case ("sensing", "set", *rest) | ("machine" | "operation" | "sensing", *rest):
            return KEYS_AT.get(".".join(map(str, place)), ".".join(map(str, rest)))
    return KEYS_AT.get(".".join(map(str, place)), ".".join(map(str, place)))


class Share(NamedTuple):
    """A length `value` (m) that is a part of another length `whole` (m), which `of` names.

    At most the share `most` of `whole` is plausible. A value of `whole` or more is impossible.
    """

    key: str
    value: float
    most: float
    whole: float
    of: str

    @property
    def question(self) -> str:
        """The question whether the value was given in mm or um; empty where the value is plausible in neither unit."""
        return length_question(self.value, self.most * self.whole)


def shares(scenario: Scenario) -> Iterator[Share]:
    """Yield a `Share` for every length of a scenario that is a part of another length, plausible or not."""
    machine, casing, film = scenario.machine, scenario.machine.casing, scenario.machine.disk_support.squeeze_film
    tip, tips = machine.tip_radius_m, "the radius of the blade tips"
    mean, ring = machine.casing_mean_radius_m, "the radius of the casing"
    yield Share("clearance_m", casing.clearance_m, 0.02, tip, tips)
    yield Share("ovality_m", casing.ovality_m, 0.05, tip, tips)
    yield Share("casing_thickness_m", casing.thickness_m, 0.1, mean, ring)
    if scenario.contact.liner:
        yield Share("contact.liner.thickness_m", scenario.contact.liner.thickness_m, 0.1, mean, ring)
    if film:
        key = "disk_support.squeeze_film.clearance_m"
        yield Share(key, film.clearance_m, 0.05, film.radius_m, "the radius of the journal")
    for key in ("runout_m", "shaft_drift_m") if scenario.surroundings else ():
        value = getattr(scenario.surroundings, key)
        yield Share(f"surroundings.{key}", value, 0.02, machine.disk.bore_radius_m, "the radius of the disk's bore")
    for number, part in enumerate(scenario.sensing.set.shaft_runout):
        key = f"shaft_runout.{number}.amplitude_m"
        yield Share(key, part.amplitude_m, 0.02, machine.disk.bore_radius_m, "the radius of the disk's bore")


def _tones(scenario: Scenario) -> Iterator[str]:
    """Yield tones above half the sample rate, which no channel shows."""
    limit, speed = scenario.sensing.sample_rate_hz / 2, scenario.operation.rotation_frequency_hz
    for number, tone in enumerate(scenario.surroundings.tones if scenario.surroundings else ()):
        hertz = tone.order_at(speed) * speed
        if hertz > limit:
            key = "frequency_hz" if tone.order is None else "order"
            value = tone.frequency_hz if tone.order is None else tone.order
            yield f"surroundings.tones.{number}.{key} = {value:g}: at {hertz:g} Hz; channels show at most {limit:g} Hz"


def _late_faults(scenario: Scenario) -> Iterator[str]:
    """Faults that grow only after the record."""
    operation = scenario.operation
    record = operation.duration_s or operation.record_turns / operation.rotation_frequency_hz
    for fault in scenario.machine.faults:
        start = getattr(fault, "start_s", 0.0)
        if start >= record:
            yield f"start_s of {fault.kind} = {start:g}: it never begins, the record lasts {record:.4g} s"


def _shares(scenario: Scenario) -> Iterator[str]:
    for each in shares(scenario):
        if each.value > each.most * each.whole:
            percent = 100 * each.value / each.whole
            yield f"{each.key} = {each.value:g}: {digits(percent)} % of {each.of}{each.question}"


def _sizes(scenario: Scenario) -> Iterator[str]:
    disk, blades, casing = scenario.machine.disk, scenario.machine.blades, scenario.machine.casing
    rim, tip = disk.rim_radius_m, scenario.machine.tip_radius_m
    liner, film = scenario.contact.liner, scenario.machine.disk_support.squeeze_film
    for key, value, limit, what in (
        ("disk.bore_thickness_m", disk.bore_thickness_m, 2 * rim, "the disk's diameter"),
        ("disk.rim_thickness_m", disk.rim_thickness_m, 2 * rim, "the disk's diameter"),
        ("blades.length_m", blades.length_m, 10 * rim, "ten times the rim's radius"),
        ("blades.root_chord_m", blades.root_chord_m, 2 * tip, "the diameter of the tips"),
        ("blades.tip_chord_m", blades.tip_chord_m, 2 * tip, "the diameter of the tips"),
        ("blades.root_thickness_m", blades.root_thickness_m, blades.root_chord_m, "the chord there"),
        ("blades.tip_thickness_m", blades.tip_thickness_m, blades.tip_chord_m, "the chord there"),
        ("casing.width_m", casing.width_m, 10 * tip, "ten times the radius of the tips"),
        ("contact.liner.width_m", liner.width_m if liner else 0.0, casing.width_m, "the width of the casing"),
        ("disk_support.squeeze_film.radius_m", film.radius_m if film else 0.0, rim, "the rim's radius"),
        ("disk_support.squeeze_film.length_m", film.length_m if film else 0.0, 2 * rim, "the disk's diameter"),
    ):
        if value > limit:
            yield f"{key} = {value:g}: larger than {what}, {limit:g} m{length_question(value, limit)}"


def _supports(scenario: Scenario) -> Iterator[str]:
    machine, support, casing = scenario.machine, scenario.machine.disk_support, scenario.machine.casing
    mass = blisk_mass(machine)
    polar = mass * machine.disk.rim_radius_m**2 / 2
    ring = 2 * math.pi * machine.casing_mean_radius_m * casing.thickness_m * casing.width_m
    node = ring * casing.material.density_kg_per_m3 / casing.nodes
    softest = min(casing.radial_support_stiffness_n_per_m, casing.circumferential_support_stiffness_n_per_m)
    for key, value, inertia, what in (
        ("disk_support_stiffness_n_per_m", support.lateral_stiffness_n_per_m, mass, "blisk"),
        ("disk_support.axial_stiffness_n_per_m", support.axial_stiffness_n_per_m, mass, "blisk"),
        ("disk_support.tilt_stiffness_nm_per_rad", support.tilt_stiffness_nm_per_rad, polar / 2, "blisk"),
        ("disk_support.torsion_stiffness_nm_per_rad", support.torsion_stiffness_nm_per_rad, polar, "blisk"),
        ("casing_support_stiffness_n_per_m", softest, node, "casing"),
    ):
        if _hz(value, inertia) < LEAST_HZ:
            unit = next((each for each in STIFFNESSES if _hz(value * each[1], inertia) >= SUPPORTED_HZ[0]), None)
            asked = f"; were {unit[0]} meant, {value * unit[1]:g} N/m?" if unit and key.endswith("n_per_m") else ""
            yield f"{key} = {value:g}: on it the {what} has a frequency of {_hz(value, inertia):.2g} Hz{asked}"


def _hz(stiffness: float, inertia: float) -> float:
    return math.sqrt(stiffness / inertia) / (2 * math.pi)


def _unbalance(scenario: Scenario) -> Iterator[str]:
    machine = scenario.machine
    for key, value in unbalances(machine):
        away = eccentricity(machine, value)
        if away > MOST_ECCENTRICITY * machine.tip_radius_m:
            yield f"{key} = {value:g}: moves the centre of mass of the blisk {digits(away)} m off the axis{gram(value)}"


def _speed(scenario: Scenario) -> Iterator[str]:
    operation = scenario.operation
    fastest = max(operation.speed_rpm, operation.end_speed_rpm or 0.0)
    tips = operation.rotation.fastest * scenario.machine.tip_radius_m
    if tips > MOST_TIP_SPEED:
        key = "speed_rpm" if fastest == operation.speed_rpm else "end_speed_rpm"
        yield f"{key} = {fastest:g}: the blade tips move at {digits(tips)} m/s, more than {MOST_TIP_SPEED:,g}"


def _rate(scenario: Scenario) -> Iterator[str]:
    rate = scenario.sensing.sample_rate_hz
    turn = scenario.operation.rotation.fastest / (2 * math.pi)
    if rate < LEAST_ORDERS * turn:
        fits = LEAST_ORDERS * turn <= 1e3 * rate <= 1e6
        question = f"; were kHz meant, {1e3 * rate:g} Hz?" if fits else ""
        yield f"sample_rate_hz = {rate:g}: no channel shows the rotation, which has up to {turn:.4g} Hz{question}"
    slowest = scenario.operation.rotation.slowest / (2 * math.pi)
    if scenario.signal_seconds * slowest < 1:
        yield f"signal_seconds = {scenario.signal_seconds:g}: less than one turn, which takes {1 / slowest:.3g} s"
    least = scenario.operation.steps_per_turn
    factor = steps_per_turn(scenario) // least
    if factor >= MOST_STEP_FACTOR:
        which, fed = "sample_rate_hz", rate
        if scenario.sensing.set.front_end_hz > rate:
            which, fed = "sensors.set: bandwidth_hz or resonance_hz", scenario.sensing.set.front_end_hz
        steps = f"{factor * least:,} steps a turn instead of {least:,}"
        yield f"{which} = {fed:g}: needs {steps}, a run takes up to {factor} times as long"


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
            yield f"{key} = {angle:g}: {_QUARTERS[quarters]}; were rad meant, {90 * quarters} degrees?"


def _arrivals(scenario: Scenario) -> Iterator[str]:
    turn = scenario.operation.rotation.fastest / (2 * math.pi)
    for sensor in scenario.sensing.set.sensors:
        if not isinstance(sensor, TimingProbe | OncePerRev):
            continue
        passages = turn * (scenario.machine.blades.count if isinstance(sensor, TimingProbe) else 1)
        if 0 < sensor.clock_hz < COUNTS_A_PASSAGE * passages:
            asked = f"; were MHz meant, {1e6 * sensor.clock_hz:g} Hz?" if sensor.clock_hz <= 1000 else ""
            counts = f"it counts {digits(sensor.clock_hz / passages)} times between two passages"
            yield f"clock_hz of {sensor.name} = {sensor.clock_hz:g}: {counts}{asked}"
        if sensor.jitter_s * passages * COUNTS_A_PASSAGE > 1:
            asked = f"; were us meant, {1e-6 * sensor.jitter_s:g} s?" if sensor.jitter_s > 1e-3 else ""
            share = f"{digits(100 * sensor.jitter_s * passages)} % of the time between two passages"
            yield f"jitter_s of {sensor.name} = {sensor.jitter_s:g}: {share}{asked}"


def _chains(scenario: Scenario) -> Iterator[str]:
    """Yield sensors whose signal is lost: noise, offset or drift as large as the range, or gaps without end."""
    for sensor in scenario.sensing.set.sampled:
        low, high = sensor.full_range
        seconds, rate = scenario.signal_seconds, scenario.sensing.sample_rate_hz
        for key, value, size in (
            ("noise_rms", sensor.noise_rms, sensor.noise_rms),
            ("noise_density", sensor.noise_density, sensor.noise_density * math.sqrt(rate / 2)),
            ("offset", sensor.offset, abs(sensor.offset)),
            ("drift_per_s", sensor.drift_per_s, abs(sensor.drift_per_s) * seconds),
        ):
            if size > high - low:
                shown = f"[{low:g}, {high:g}] {sensor.unit}".removesuffix(" 1")
                yield f"{key} of {sensor.name} = {value:g}: more than its whole range, {shown}"
        dropped = sensor.dropouts_per_s * sensor.dropout_s
        if dropped > MOST_DROPPED:
            lost = f"{digits(100 * dropped)} % of the signal is lost"
            yield f"dropouts_per_s of {sensor.name} = {sensor.dropouts_per_s:g}: {lost}"


CHECKS = (
    _usual,
    _shares,
    _sizes,
    _supports,
    _unbalance,
    _speed,
    _rate,
    _angles,
    _arrivals,
    _chains,
    _tones,
    _late_faults,
    _faults,
)


def unbalances(machine: Machine) -> Iterator[tuple[str, float]]:
    """Yield the key and the value (kg m) of every unbalance of a machine."""
    yield "unbalance_kg_m", machine.unbalance_kg_m
    for number, each in enumerate(machine.unbalances):
        yield f"unbalances.{number}.kg_m", each.kg_m


def eccentricity(machine: Machine, unbalance: float) -> float:
    """Return how far an unbalance (kg m) moves the centre of mass of the blisk from the axis, in m."""
    return unbalance / blisk_mass(machine)


def gram(unbalance: float) -> str:
    """Return the question whether an unbalance (kg m) was given in g mm; empty where it is below 10."""
    return f"; were g mm meant, {unbalance * 1e-6:g} kg m?" if unbalance >= LEAST_GRAM_MILLIMETRES else ""


def length_question(value: float, most: float) -> str:
    """Return the question whether a length was given in mm or um; empty where `value` is plausible in neither unit.

    `most` is the largest plausible length in m, LEAST_SHARE of it the smallest. mm is tried first. Whether `value` is
    plausible in m is not checked.
    """
    for unit, size in LENGTHS:
        if LEAST_SHARE * most <= value * size <= most:
            return f"; were {unit} meant, {value * size:g} m?"
    return ""
