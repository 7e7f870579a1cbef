"""What the keys of an operation's speed profile must be together."""

from __future__ import annotations

from rubgen.scenario.scenario import RPM, Operation

PROFILE_KEYS: dict[str, tuple[str, ...]] = {
    "steady": (),
    "run-up": ("end_speed_rpm", "duration_s"),
    "coast-down": ("end_speed_rpm", "duration_s"),
    "fluctuating": ("duration_s", "fluctuation_rpm"),
}
"""The keys that each profile needs; it takes no others of these."""
LEAST_PERIOD_TURNS = 0.1
"""Shorter fluctuations are not resolved by the steps."""


def profile_problem(operation: Operation) -> str | None:
    """What is wrong with an operation's profile, as key, value, what is allowed and how to mend it; None if nothing."""
    return _key_problem(operation) or _value_problem(operation) or _band_problem(operation)


def _key_problem(operation: Operation) -> str | None:
    given = {
        "end_speed_rpm": operation.end_speed_rpm is not None,
        "duration_s": operation.duration_s is not None,
        "fluctuation_rpm": operation.fluctuation_rpm > 0,
    }
    for key, is_given in given.items():
        needed = key in PROFILE_KEYS[operation.profile]
        if needed and not is_given:
            return f'{key}: the profile "{operation.profile}" needs it; add it'
        if is_given and not needed:
            value = getattr(operation, key)
            return f'{key} = {value:g}: the profile "{operation.profile}" has none; remove it or choose another profile'
    return None


def _value_problem(operation: Operation) -> str | None:
    start, end = operation.speed_rpm, operation.end_speed_rpm
    if operation.profile == "run-up" and end is not None and end <= start:
        return f"end_speed_rpm = {end:g}: a run-up ends above its start, speed_rpm = {start:g}; raise it"
    if operation.profile == "coast-down" and end is not None and end >= start:
        return f"end_speed_rpm = {end:g}: a coast-down ends below its start, speed_rpm = {start:g}; lower it"
    if operation.fluctuation_rpm >= start:
        return f"fluctuation_rpm = {operation.fluctuation_rpm:g}: must be below speed_rpm = {start:g}; lower it"
    period, least = operation.fluctuation_period_s, LEAST_PERIOD_TURNS * 60 / start
    if operation.profile == "fluctuating" and period < least:
        return f"fluctuation_period_s = {period:g}: must be at least a tenth of a turn, {least:.3g} s; raise it"
    return None


def _band_problem(operation: Operation) -> str | None:
    rotation = operation.rotation
    slowest, fastest = rotation.slowest / RPM, rotation.fastest / RPM
    for low, high in operation.forbidden_speed_rpm:
        if low > high:
            return f"forbidden_speed_rpm = [{low:g}, {high:g}]: the lower end comes first; swap the two"
        if slowest <= high * (1 + 1e-12) and fastest >= low * (1 - 1e-12):
            way = f"goes from {slowest:g} to {fastest:g}" if fastest > slowest else f"is {slowest:g}"
            return f"forbidden_speed_rpm = [{low:g}, {high:g}]: the speed {way} rev/min; stay out of the band"
    return None
