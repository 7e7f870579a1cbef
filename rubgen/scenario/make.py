"""Make a single run from its keys: the same names, units and checks for Python and for `rubgen simulate`."""

import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import wraps
from inspect import signature
from pathlib import Path
from typing import Any, ParamSpec

from pydantic import TypeAdapter

from rubgen.errors import UserError
from rubgen.machine.problems import nearest, validated
from rubgen.scenario.faults import FAULT_KEYS, with_given_faults
from rubgen.scenario.feasible import check_feasible
from rubgen.scenario.plausible import warn_of
from rubgen.scenario.profiles import check_used
from rubgen.scenario.recipe import Recipe
from rubgen.scenario.scenario import ProfileName, Scenario
from rubgen.scenario.surroundings import Surroundings
from rubgen.scenario.vary import DRAWN, FREE_PENETRATION, TWO_CLEARANCES, vary

P = ParamSpec("P")
TABLES = {
    "operation": ("profile",),
    "simulation": ("settle_turns", "record_turns", "steps_per_turn"),
    "sensors": ("sample_rate_hz",),
    "output": ("signal_seconds",),
    "labels": ("lyapunov",),
}
"""The tables of a recipe with keys that are not drawn."""
SURROUNDINGS_KEYS = ("background_m_per_s2", "blade_passing_m_per_s2", "runout_m", "path_gain")
_RECIPE = TypeAdapter(Recipe)
_SURROUNDINGS = TypeAdapter(Surroundings)


def _known_keys(function: Callable[P, Scenario]) -> Callable[P, Scenario]:
    """Return the function with a check that refuses an unknown key and names the nearest known one."""
    known = [name for name, each in signature(function).parameters.items() if each.kind is not each.VAR_KEYWORD]

    @wraps(function)
    def checked(*arguments: P.args, **keys: P.kwargs) -> Scenario:
        for key in keys:
            if key not in (*known, *FAULT_KEYS):
                raise UserError(f"{key}: unknown key; {nearest(key, known)}")
        return function(*arguments, **keys)

    return checked


@_known_keys
def make_scenario(
    machine: str | Path = "zeng2019",
    *,
    speed_rpm: float | None = None,
    clearance_m: float | None = None,
    free_penetration_m: float | None = None,
    ovality_m: float | None = None,
    disk_support_stiffness_n_per_m: float | None = None,
    casing_support_stiffness_n_per_m: float | None = None,
    friction: float | None = None,
    lobes: float | None = None,
    unbalance_kg_m: float | None = None,
    casing_thickness_m: float | None = None,
    lateral_damping: float | None = None,
    support_anisotropy: float | None = None,
    gravity_m_per_s2: float | None = None,
    unbalance_angle_deg: float | None = None,
    background_m_per_s2: float | None = None,
    blade_passing_m_per_s2: float | None = None,
    runout_m: float | None = None,
    path_gain: float | None = None,
    fault: str | Sequence[str] | None = None,
    profile: ProfileName = "steady",
    end_speed_rpm: float | None = None,
    duration_s: float | None = None,
    fluctuation_rpm: float | None = None,
    fluctuation_period_s: float | None = None,
    settle_turns: int | None = None,
    record_turns: int | None = None,
    steps_per_turn: int = 1024,
    sample_rate_hz: float = 25600.0,
    sensors: str | Path = "default",
    signal_seconds: float = 1.0,
    seed: int = 0,
    lyapunov: bool | None = None,
    **fault_keys: float | str,
) -> Scenario:
    """Describe one run of a machine for `simulate`; a key that is not given keeps the machine's value.

    - `machine`: name of a preset ("zeng2019"), or path of a machine TOML
    - `speed_rpm`: spin speed in rev/min, of a run-up or coast-down at its start, > 0; 10,000 when not given
    - `clearance_m`: smallest gap between blade tips and casing at rest in m, > 0
    - `free_penetration_m`: how deep tips would be without contact in m; the clearance follows from it, in its place
    - `ovality_m`: largest minus smallest radius of the casing's inner surface in m, >= 0
    - `disk_support_stiffness_n_per_m`: lateral stiffness of the disk support, mean of X and Y, in N/m, > 0
    - `casing_support_stiffness_n_per_m`: radial and circumferential stiffness under each casing node in N/m, > 0
    - `friction`: Coulomb coefficient of sliding friction, 0 to 0.3
    - `lobes`: number of lobes of the casing's inner surface, whole, >= 2
    - `unbalance_kg_m`: mass unbalance of the blisk in kg m, >= 0
    - `casing_thickness_m`: radial thickness of the casing ring in m, > 0
    - `lateral_damping`: damping ratio of the blisk moving laterally as a rigid body, 0 to below 1
    - `support_anisotropy`: (k_X - k_Y) / (k_X + k_Y) of the disk support, above -1 and below 1
    - `gravity_m_per_s2`: gravity along -Y on the blisk in m/s2, >= 0; 0 for a vertical axis
    - `unbalance_angle_deg`: angle of the unbalance from blade 0 in degrees, -360 to 360
    - `background_m_per_s2`: rms of the casing's broadband background at 10,000 rev/min in m/s2, >= 0
    - `blade_passing_m_per_s2`: rms of the casing's answer to the blades' pressure at 10,000 rev/min in m/s2, >= 0
    - `runout_m`: amplitude of order 1 of the shaft's runout in m, >= 0; orders 2 and 3 have 1/2 and 1/3 of it
    - `path_gain`: share of the motion of the machine's frame that the casing's sensors feel, >= 0; 1 is all of it
    - `fault`: kind of a fault of the machine, or several kinds in a list (docs/faults.md)
    - `profile`: of the speed: "steady", "run-up", "coast-down" or "fluctuating"
    - `end_speed_rpm`: speed at the end of a run-up or coast-down in rev/min, > 0; these two profiles need it
    - `duration_s`: duration of a record whose speed changes in s, > 0; every profile but "steady" needs it
    - `fluctuation_rpm`: amplitude of a fluctuating speed in rev/min, below speed_rpm; this profile needs it
    - `fluctuation_period_s`: period of a fluctuating speed in s, > 0; 1 when not given
    - `settle_turns`: turns before the record, >= 1; from the slowest decay of the machine when not given
    - `record_turns`: turns from which the labels of a steady run come, >= 500; 500 when not given
    - `steps_per_turn`: least number of integration steps in a turn, at most 16384
    - `sample_rate_hz`: samples a second of the recorded channels, > 0
    - `sensors`: sensor set, "default", "rig", "field" or the path of a TOML
    - `signal_seconds`: length of the recorded signals in s, the end of the record, at most all of it
    - `seed`: seed of the sensor noise and the surroundings, >= 0
    - `lyapunov`: whether to compute the Lyapunov exponent of a steady run, half as long again; yes when not given
    - `fault_keys`: values of these faults, each by its key: parallel_m = 5e-5

    Warns (RubgenWarning) of values that are allowed but hardly intended. Raises UserError for an unknown machine or
    sensor set, a value that is not allowed, and keys that exclude each other.
    """
    given = {key: value for key, value in locals().items() if key != "fault_keys" and value is not None}
    return _checked_scenario(given, fault_keys)


def _checked_scenario(given: dict[str, Any], fault_keys: dict[str, Any]) -> Scenario:
    values, varied = _recipe_values(given), {entry.key: given[entry.key] for entry in DRAWN if entry.key in given}
    if FREE_PENETRATION.key in varied and "clearance_m" in varied:
        raise UserError(TWO_CLEARANCES)
    levels = {key: given[key] for key in SURROUNDINGS_KEYS if key in given}
    around = validated("", levels, _SURROUNDINGS) if levels else None
    recipe = validated("", values | ({"surroundings": levels} if levels else {}), _RECIPE, _key_alone)
    check_used("", {**values, "vary": varied}, _key_alone)
    scenario = vary(replace(recipe.base, surroundings=around), varied)
    scenario = with_given_faults(scenario, given.get("fault", ()), fault_keys)
    with recipe.machine_named():
        check_feasible(scenario)
    warn_of([scenario])
    return scenario


def _recipe_values(given: dict[str, Any]) -> dict[str, Any]:
    """Return the values of a recipe of one run: all given keys except the keys of `[vary]`."""
    values: dict[str, Any] = {"name": "run", "runs": 1}
    for table, keys in TABLES.items():
        used = {key: given[key] for key in keys if key in given}
        values |= {table: used} if used else {}
    values |= {key: _text(given[key]) for key in ("machine", "seed") if key in given}
    if "sensors" in given:
        values["sensors"] = {**values.get("sensors", {}), "set": _text(given["sensors"])}
    return values


def _text(value: Any) -> Any:
    """Return a path as text."""
    return os.fspath(value) if isinstance(value, os.PathLike) else value


def _key_alone(path: tuple[int | str, ...]) -> tuple[int | str, ...]:
    """Return the key of `make_scenario` for a place of the recipe."""
    return ("sensors",) if path == ("sensors", "set") else path[-1:]
