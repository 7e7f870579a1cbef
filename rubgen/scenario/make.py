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

    A name ends with its unit: m, s, hz, deg, rpm (rev/min), n_per_m (N/m), kg_m (kg m), m_per_s2 (m/s2), or has none.

    - `machine`: A preset of rubgen by its name, or the path of a machine in TOML.
    - `speed_rpm`: Spin speed; 10,000 when not given.
    - `profile`: "steady"; "run-up" or "coast-down" from `speed_rpm` to `end_speed_rpm`; or "fluctuating" by
      `fluctuation_rpm` with the period `fluctuation_period_s` (1 when not given). All but "steady" need these keys and
      `duration_s`, the length of the record.
    - `clearance_m`: Smallest gap between blade tips and casing at rest. In its place `free_penetration_m` may say how
      deep tips would be without contact.
    - `ovality_m`, `lobes`: Largest minus smallest radius of the inner surface; number of narrow places around it.
    - `casing_thickness_m`: Radial thickness of the ring.
    - `casing_support_stiffness_n_per_m`: Radial and circumferential stiffness under each casing node.
    - `disk_support_stiffness_n_per_m`: Lateral stiffness of the shaft and bearings at the disk centre, mean of X and Y;
      `support_anisotropy` is (k_X - k_Y) / (k_X + k_Y).
    - `lateral_damping`: Damping ratio of the blisk that moves laterally as a rigid body.
    - `unbalance_kg_m`: Mass times radius of the unbalance on the disk, at `unbalance_angle_deg` ahead of blade 0.
    - `friction`, `gravity_m_per_s2`: Coulomb coefficient of sliding friction; gravity along -Y on the blisk.
    - `fault`: Kind of a fault, or a list of kinds (docs/faults.md); `fault_keys` are its values: parallel_m = 5e-5.
    - `background_m_per_s2`, `blade_passing_m_per_s2`, `runout_m`, `path_gain`: What sensors feel besides the motion
      (docs/surroundings.md); 0 when not given.
    - `settle_turns`, `record_turns`: Turns before the record, and of a steady record; "auto" and 500 when not given.
    - `steps_per_turn`: Least number of integration steps in a turn.
    - `sensors`: A sensor set of rubgen by its name, or the path of one in TOML, sampled at `sample_rate_hz`.
    - `signal_seconds`, `seed`: Length of the recorded signals, the end of the record; seed of all random numbers.
    - `lyapunov`: Whether the largest Lyapunov exponent of a steady run is computed; true when not given.

    Warns (RubgenWarning) of what is hardly intended. Raises UserError for an unknown key, machine or sensor set, keys
    that exclude each other, and a value out of its range (`rubgen simulate --help`).
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
