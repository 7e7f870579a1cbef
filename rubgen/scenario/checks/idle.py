"""Find keys of the surroundings, and faults, that change no recorded channel of a scenario."""

from collections.abc import Sequence

from rubgen.scenario.scenario import Scenario
from rubgen.scenario.surroundings import Surroundings
from rubgen.taps import CasingAcceleration, CentreDisplacement, HousingAcceleration, Tap

CASING, SHAKEN = (CasingAcceleration,), (CasingAcceleration, HousingAcceleration)
FELT_BY: dict[str, tuple[tuple[type[Tap], ...], str]] = {
    "background_m_per_s2": (SHAKEN, "accelerometer"),
    "blade_passing_m_per_s2": (CASING, "accelerometer on the casing"),
    "path_gain": (CASING, "accelerometer on the casing"),
    "runout_m": ((CentreDisplacement,), "proximity probe"),
    "shaft_drift_m": ((CentreDisplacement,), "proximity probe"),
    "tones": (SHAKEN, "accelerometer"),
}
"""The taps that feel each level and the tones, and the sensors of these taps."""
SCALED_BY = {
    "background_slope": ("background_m_per_s2",),
    "speed_exponent": ("background_m_per_s2", "blade_passing_m_per_s2"),
}
"""The levels without which a key changes nothing."""


def idle_surroundings(scenario: Scenario) -> dict[str, str]:
    """Return the keys of the scenario's surroundings that change no recorded channel, each with the text of a warning.

    A key is returned if its value differs from its default and changes no channel: no sensor feels it, or all levels
    that it scales are 0. The keys are written as `surroundings.KEY`. The result is empty if every key changes a
    channel. The scenario must have surroundings.
    """
    values, usual, why = vars(scenario.surroundings), vars(Surroundings()), _reasons(scenario)
    given = {key: value for key, value in values.items() if value != usual[key]}
    shown = {key: "" if key == "tones" else f" = {value:g}" for key, value in given.items() if key in why}
    names = {key: f"surroundings.{key}" for key in shown}
    return {name: f"{name}{shown[key]}: changes no channel: {why[key]}" for key, name in names.items()}


def _reasons(scenario: Scenario) -> dict[str, str]:
    """Return why keys of the surroundings would change no channel, whatever their values."""
    values, sensors = vars(scenario.surroundings), scenario.sensing.set
    taps = [sensor.tap for sensor in sensors.sampled]
    why = {
        key: f"the sensor set {sensors.name} has no {which}"
        for key, (kinds, which) in FELT_BY.items()
        if not any(isinstance(tap, kinds) for tap in taps)
    }
    for key, levels in SCALED_BY.items():
        if not any(values[level] for level in levels):
            why[key] = f"without {' or '.join(levels)}"
    if not (sensors.on_housing or values["path_gain"]):
        why["frame_spread"] = "without path_gain or an accelerometer on the housing"
    return why


def idle(scenarios: Sequence[Scenario]) -> dict[str, str]:
    """Return the keys that change no channel in any of the scenarios, each with the text of a warning.

    Such a key is a key of the surroundings, or `faults.KIND` for a fault that only shakes a frame which no sensor
    feels. A text has the value of the first scenario in which the key differs from its default. A key with its default
    in all scenarios is not returned.
    """
    around = [scenario for scenario in scenarios if scenario.surroundings]
    useless = {key: text for scenario in reversed(around) for key, text in idle_surroundings(scenario).items()}
    reasons = [{f"surroundings.{key}" for key in _reasons(scenario)} for scenario in around]
    found = {key: text for key, text in useless.items() if all(key in names for names in reasons)}
    striking = [fault for scenario in scenarios for fault in scenario.machine.faults if fault.STRIKES]
    if striking and not any(scenario.frame for scenario in scenarios):
        which = f"faults.{striking[0].kind}"
        found[which] = f"{which}: changes no channel: without path_gain or an accelerometer on the housing"
    return found
