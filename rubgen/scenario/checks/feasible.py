"""Check a scenario beyond the ranges of its single values, before anything is computed."""

import math

from rubgen.errors import UserError
from rubgen.machine.quantities import MOST_STEPS
from rubgen.machine.schema_nodes import digits
from rubgen.scenario.checks.plausible import eccentricity, gram, shares, unbalances
from rubgen.scenario.checks.profiles import profile_problem
from rubgen.scenario.checks.reducible import reduction_problem
from rubgen.scenario.costs import STEPS_PER_SAMPLE, run_problem
from rubgen.scenario.faults import kind_of
from rubgen.scenario.scenario import Scenario
from rubgen.sensors.kinds.blade_strain import BladeStrain
from rubgen.sensors.kinds.blade_tip_timing import TimingProbe

MIN_RECORD_TURNS = 500
"""Least number of recorded turns. With fewer, labels call quasi-periodic motion chaotic (with 49 turns, for
example)."""


def check_feasible(scenario: Scenario, source: str = "") -> None:
    """Check a scenario before its run: speed profile, lengths, sizes, faults, sensors, numbers of modes, memory.

    Whether there is a motion without rub is not checked: it is known only from the model. Raises UserError with the
    first problem. `source` is the beginning of the message with its ": "; keys are named as in a recipe.
    """
    for problem in (*PROBLEMS, *SENSOR_PROBLEMS, _cost_problem):
        text = problem(scenario)
        if text:
            raise UserError(source + text)


def _profile_problem(scenario: Scenario) -> str | None:
    problem = profile_problem(scenario.operation)
    return problem and f"operation.{problem}"


def _record_problem(scenario: Scenario) -> str | None:
    turns = scenario.operation.record_turns
    if turns >= MIN_RECORD_TURNS or scenario.operation.profile != "steady":
        return None
    needed = f"labels need at least {MIN_RECORD_TURNS} turns, the Lyapunov exponent too"
    return f"simulation.record_turns = {turns}: {needed}; raise it"


def _tail_problem(scenario: Scenario) -> str | None:
    operation = scenario.operation
    longest = operation.duration_s or operation.record_turns / operation.rotation_frequency_hz
    if scenario.signal_seconds <= longest:
        return None
    if operation.duration_s:
        return (
            f"output.signal_seconds = {scenario.signal_seconds:g}: the record lasts {longest:.4g} s, "
            "operation.duration_s; lower it or raise that"
        )
    return (
        f"output.signal_seconds = {scenario.signal_seconds:g}: the record lasts {longest:.4g} s "
        f"({operation.record_turns} turns at {operation.speed_rpm:g} rev/min); lower it or raise record_turns"
    )


def _sample_problem(scenario: Scenario) -> str | None:
    seconds, rate = scenario.signal_seconds, scenario.sensing.sample_rate_hz
    if round(seconds * rate) >= 1:
        return None
    return (
        f"output.signal_seconds = {seconds:g}: holds no sample at sensors.sample_rate_hz = {rate:g}, one takes "
        f"{1 / rate:.3g} s; raise one of them"
    )


def _highest_hz(scenario: Scenario) -> float:
    """Return the highest sample rate for which the largest number of steps a turn is enough."""
    return MOST_STEPS * _highest_speed_rpm(scenario) / 60 / STEPS_PER_SAMPLE


def _highest_speed_rpm(scenario: Scenario) -> float:
    """Return the speed that determines the step."""
    operation = scenario.operation
    return max(operation.speed_rpm, operation.end_speed_rpm or 0.0) + operation.fluctuation_rpm


def _rate_problem(scenario: Scenario) -> str | None:
    rate, operation = scenario.sensing.sample_rate_hz, scenario.operation
    highest = _highest_hz(scenario)
    if rate <= highest:
        return None
    return (
        f"sensors.sample_rate_hz = {rate:g}: at {operation.speed_rpm:g} rev/min the step feeds at most "
        f"{highest:.6g} Hz; lower it or raise the lowest speed"
    )


def _front_end_problem(scenario: Scenario) -> str | None:
    highest = _highest_hz(scenario)
    for sensor in scenario.sensing.set.sampled:
        for key in ("bandwidth_hz", "resonance_hz"):
            frequency = getattr(sensor, key)
            if frequency is not None and frequency > highest:
                return (
                    f"sensors.set: {key} = {frequency:g} of {sensor.name}: at {scenario.operation.speed_rpm:g} rev/min "
                    f"the step feeds at most {highest:.6g} Hz; lower it, leave it out or raise the lowest speed"
                )
    return None


def _blade_problem(scenario: Scenario) -> str | None:
    blades, lost = scenario.machine.blades, scenario.machine.lost_blades
    for sensor in scenario.sensing.set.sensors:
        if isinstance(sensor, BladeStrain) and sensor.blade >= blades.count:
            return (
                f"sensors.set: blade = {sensor.blade} of {sensor.name}: the machine has {blades.count} blades; "
                f"give 0 to {blades.count - 1}"
            )
        if isinstance(sensor, BladeStrain) and sensor.blade in lost:
            return (
                f"sensors.set: blade = {sensor.blade} of {sensor.name}: the fault lost-blade has taken this blade; "
                f"give another one"
            )
    return None


def _axial_problem(scenario: Scenario) -> str | None:
    blades = scenario.machine.blades
    half = abs(math.sin(math.radians(blades.tip_angle_deg))) * blades.tip_chord_m / 2
    for sensor in scenario.sensing.set.sensors:
        if isinstance(sensor, TimingProbe) and abs(sensor.axial_m) > half:
            return (
                f"sensors.set: axial_m = {sensor.axial_m:g} of {sensor.name}: the tips reach {half:.4g} m to either "
                "side; give a place between"
            )
    return None


def _frame_problem(scenario: Scenario) -> str | None:
    """Return the problem of a sensor or a level that needs the machine's frame, where it has none; else None."""
    if scenario.machine.frame is not None:
        return None
    remedy = "the machine has no [frame]; give it one, or leave this out"
    if scenario.sensing.set.on_housing:
        return f"sensors.set: kind = 'housing_accelerometer' of {scenario.sensing.set.on_housing[0].name}: {remedy}"
    gain = scenario.surroundings.path_gain if scenario.surroundings else 0.0
    return f"surroundings.path_gain = {gain:g}: {remedy}" if gain else None


def _size_problem(scenario: Scenario) -> str | None:
    """Impossible sizes: an oval larger than the radius, a ring without a bore, a blisk beside its axis."""
    for each in shares(scenario):
        if each.value >= each.whole:
            remedy = each.question or "; lower it"
            return f"{each.key} = {each.value:g}: must be below {each.of}, {each.whole:g} m{remedy}"
    for key, value in unbalances(scenario.machine):
        away = eccentricity(scenario.machine, value)
        if away >= scenario.machine.tip_radius_m:
            moved = f"would move the centre of mass {digits(away)} m off the axis"
            return f"{key} = {value:g}: {moved}, outside of the blisk{gram(value)}"
    return None


def _fault_problem(scenario: Scenario) -> str | None:
    for fault in scenario.machine.faults:
        problem = fault.problem(scenario.machine)
        if problem:
            return f"faults: {kind_of(fault)}: {problem}"
    return None


def _cost_problem(scenario: Scenario) -> str | None:
    return reduction_problem(scenario.machine, scenario.reduction) or run_problem(scenario)


PROBLEMS = (
    _profile_problem,
    _record_problem,
    _tail_problem,
    _sample_problem,
    _rate_problem,
    _size_problem,
    _fault_problem,
)
SENSOR_PROBLEMS = (_front_end_problem, _blade_problem, _axial_problem, _frame_problem)
