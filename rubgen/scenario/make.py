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
from rubgen.scenario.checks.feasible import check_feasible
from rubgen.scenario.checks.plausible import warn_of
from rubgen.scenario.checks.profiles import check_used
from rubgen.scenario.faults import FAULT_KEYS, with_given_faults
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

    - `machine`: A preset of rubgen by its name, or the path of a machine in TOML.
    - `speed_rpm`: Spin speed, of a run-up or coast-down at its start; in rev/min, at least 0.001 and at most
      1,000,000; 10,000 when not given.
    - `clearance_m`: Smallest gap between blade tips and casing at rest; in m, at least 1e-07 and at most 100.
    - `free_penetration_m`: How deep tips would be without contact; the clearance follows from it; in m, at least
      -0.1 and at most 0.1.
    - `ovality_m`: Largest minus smallest radius of the inner surface; in m, at least 0 and at most 100.
    - `disk_support_stiffness_n_per_m`: Lateral stiffness of the shaft and bearings at the disk centre, mean of X
      and Y; in N/m, at least 0.001 and at most 1e+16.
    - `casing_support_stiffness_n_per_m`: Radial and circumferential stiffness under each casing node; in N/m, at
      least 0.001 and at most 1e+16.
    - `friction`: Coulomb coefficient of sliding friction; at least 0 and at most 0.3.
    - `lobes`: Number of narrow places around the inner surface; at least 2 and at most 100.
    - `unbalance_kg_m`: Mass times radius of the unbalance on the disk; in kg m, at least 0 and at most 10,000,000.
    - `casing_thickness_m`: Radial thickness of the ring; in m, at least 1e-07 and at most 100.
    - `lateral_damping`: Damping ratio of the blisk that moves laterally as a rigid body; at least 0 and below 1.
    - `support_anisotropy`: (k_X - k_Y) / (k_X + k_Y) of the lateral springs; above -1 and below 1.
    - `gravity_m_per_s2`: Gravity along -Y on the blisk; in m/s2, at least 0 and at most 10,000.
    - `unbalance_angle_deg`: Angle of unbalance_kg_m from blade 0, in the sense of rotation; in deg, at least -360
      and at most 360.
    - `background_m_per_s2`: Rms of the casing's broadband background from 10 Hz to 20 kHz, at 10,000 rev/min; in
      m/s2, at least 0 and at most 1,000,000,000; 0 when not given.
    - `blade_passing_m_per_s2`: Rms of the casing's answer to the pressure of the blades, at 10,000 rev/min; in
      m/s2, at least 0 and at most 1,000,000,000; 0 when not given.
    - `runout_m`: Amplitude of order 1 of the shaft's runout under the proximity probes; in m, at least 0 and at
      most 100; 0 when not given.
    - `path_gain`: Share of the motion of the machine's frame that the casing's sensors feel; at least 0 and at most
      1,000,000; 0 when not given.
    - `fault`: kind of a fault of the machine, or several kinds in a list (docs/faults.md)
    - `profile`: How the speed changes: not at all, linearly up, linearly down, or as a sine; "steady", "run-up",
      "coast-down", "fluctuating".
    - `end_speed_rpm`: Speed at the end of a run-up or coast-down, which need it; in rev/min, at least 0.001 and at
      most 1,000,000.
    - `duration_s`: Duration of a record whose speed changes; every profile but "steady" needs it; in s, above 0 and
      at most 100,000.
    - `fluctuation_rpm`: Amplitude of a fluctuating speed, which needs it; in rev/min, at least 0 and at most
      1,000,000; 0 when not given.
    - `fluctuation_period_s`: Period of a fluctuating speed; in s, above 0 and at most 100,000; 1 when not given.
    - `settle_turns`: Turns before the record, in which transients decay; at least 1 and at most 1,000,000 or
      "auto"; "auto" when not given.
    - `record_turns`: Turns of the record of a steady run, from which its labels come; at least 1 and at most
      1,000,000; 500 when not given.
    - `steps_per_turn`: Least number of integration steps in a turn; at least 32 and at most 16,384.
    - `sample_rate_hz`: Samples a second of every recorded channel; in Hz, above 0 and at most 1,000,000,000.
    - `sensors`: A sensor set of rubgen by its name, or the path of a sensor set in TOML.
    - `signal_seconds`: Length of the recorded signals: the end of the record; in s, above 0 and at most 100,000.
    - `seed`: Seed of all random numbers; at least 0 and at most 9,223,372,036,854,775,807.
    - `lyapunov`: Whether the largest Lyapunov exponent of each steady run is computed; true, false; true when not
      given.
    - `fault_keys`: values of these faults, each by its key: parallel_m = 5e-5

    Warns (RubgenWarning) of values that are allowed but hardly intended. Raises UserError for an unknown key, machine
    or sensor set, a value that is not allowed, and keys that exclude each other.
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
