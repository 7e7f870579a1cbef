"""Sensor sets from TOML files: those that come with rubgen, and the user's own of the same form."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from rubgen.errors import UserError
from rubgen.machine.load import read_toml
from rubgen.machine.problems import first_problem, nearest
from rubgen.scenario.sensors import KINDS, SensorSet

SETS = Path(__file__).parents[1] / "sensors" / "sets"
DEFAULT_SET = "default"


def sensor_set_names() -> list[str]:
    """Names of the sets that come with rubgen, sorted."""
    return sorted(path.stem for path in SETS.glob("*.toml"))


@cache
def default_sensor_set() -> SensorSet:
    """The set of a recipe that names none."""
    return load_sensor_set(DEFAULT_SET)


def load_sensor_set(name_or_path: str, folder: Path | None = None) -> SensorSet:
    """The set of that name, or the one in that TOML file; relative paths start from `folder`.

    A table `[kinds.<kind>]` gives values to all sensors of a kind that do not set them. Raises UserError with file,
    key, value and what is allowed when there is none, or when it is not a valid set.
    """
    if name_or_path in sensor_set_names():
        return parse_sensor_set(SETS / f"{name_or_path}.toml")
    if not name_or_path.endswith(".toml"):
        hint = nearest(name_or_path, sensor_set_names())
        raise UserError(f"sensors.set = {name_or_path!r}: no such set; {hint}, or the path of a sensor set .toml")
    return parse_sensor_set((folder or Path()) / name_or_path)


def parse_sensor_set(path: Path) -> SensorSet:
    """The set in a TOML file."""
    data = read_toml(path)
    kinds = data.pop("kinds", {})
    listed = data.get("sensors")
    if isinstance(listed, list) and isinstance(kinds, dict):
        _check_kinds(path, [str(each) for each in kinds], "kinds.")
        data["sensors"] = [_completed(path, number, each, kinds) for number, each in enumerate(listed)]
    adapter = TypeAdapter(SensorSet)
    try:
        return adapter.validate_python(data)
    except ValidationError as error:
        raise first_problem(path, error, data, adapter) from None


def _completed(path: Path, number: int, sensor: Any, kinds: dict[str, Any]) -> Any:
    """A sensor's table with the values of its kind."""
    if not isinstance(sensor, dict):
        return sensor
    if "kind" not in sensor:
        raise UserError(f"{path}: sensors.{number}.kind: this key is missing; add it, one of {', '.join(KINDS)}")
    _check_kinds(path, [str(sensor["kind"])], f"sensors.{number}.kind = ")
    return {**kinds.get(sensor["kind"], {}), **sensor}


def _check_kinds(path: Path, found: list[str], where: str) -> None:
    for kind in found:
        if kind not in KINDS:
            raise UserError(f"{path}: {where}{kind}: unknown kind of sensor; {nearest(kind, list(KINDS))}")
