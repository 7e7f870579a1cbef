"""Check the keys of an operation's speed profile."""

from collections.abc import Callable, Mapping
from typing import Any

from rubgen.errors import UserError
from rubgen.machine.problems import key_name
from rubgen.machine.quantities import Place
from rubgen.machine.sentences import toml_text
from rubgen.scenario.scenario import Operation, ProfileName
from rubgen.units import rev_per_min

PROFILES_OF: dict[str, tuple[ProfileName, ...]] = {
    "end_speed_rpm": ("run-up", "coast-down"),
    "duration_s": ("run-up", "coast-down", "fluctuating"),
    "fluctuation_rpm": ("fluctuating",),
    "fluctuation_period_s": ("fluctuating",),
    "record_turns": ("steady",),
    "lyapunov": ("steady",),
}
"""The profiles that use a key; every other key belongs to all profiles."""
NEEDED = ("end_speed_rpm", "duration_s", "fluctuation_rpm")
"""Keys that their profiles require; the others have a default."""
LEAST_PERIOD_TURNS = 0.1
"""Shorter fluctuations are not resolved by the steps."""


def check_used(source: str, recipe: Mapping[str, Any], place: Callable[[Place], Place] = lambda path: path) -> None:
    """Check that the speed profile of a recipe uses every key that the recipe contains.

    Raises UserError for an unused key. A key with the value false passes.

    - source: beginning of messages, with its ": ".
    - recipe: the TOML values.
    - place: turns a path in the recipe into the path of the key that the user wrote.
    """
    profile = recipe.get("operation", {}).get("profile", "steady")
    for table, keys in recipe.items():
        for key, value in keys.items() if isinstance(keys, Mapping) else ():
            if profile not in PROFILES_OF.get(key, (profile,)) and value is not False:
                name = key_name(place((table, key)))
                raise UserError(f"{source}{name} = {toml_text(value)}: {_has_none(profile, key)}")


def profile_problem(operation: Operation) -> str | None:
    """Return the problem of an operation's profile: key, value, what is allowed, the remedy; None without a problem."""
    return _key_problem(operation) or _value_problem(operation) or _band_problem(operation)


def _key_problem(operation: Operation) -> str | None:
    for key in NEEDED:
        value, uses = getattr(operation, key), operation.profile in PROFILES_OF[key]
        if uses and not value:
            return f'{key}: the profile "{operation.profile}" needs it; add it'
        if value and not uses:
            return f"{key} = {value:g}: {_has_none(operation.profile, key)}"
    return None


def _has_none(profile: str, key: str) -> str:
    users = " or ".join(f'"{each}"' for each in PROFILES_OF[key])
    return f'the profile "{profile}" has none; leave it out or give the profile {users}'


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
    slowest, fastest = rev_per_min(rotation.slowest), rev_per_min(rotation.fastest)
    for low, high in operation.forbidden_speed_rpm:
        if low > high:
            return f"forbidden_speed_rpm = [{low:g}, {high:g}]: the lower end comes first; swap the two"
        if slowest <= high * (1 + 1e-12) and fastest >= low * (1 - 1e-12):
            way = f"goes from {slowest:g} to {fastest:g}" if fastest > slowest else f"is {slowest:g}"
            return f"forbidden_speed_rpm = [{low:g}, {high:g}]: the speed {way} rev/min; stay out of the band"
    return None
