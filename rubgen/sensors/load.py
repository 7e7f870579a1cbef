"""Load sensor sets from TOML files: the sets of rubgen, and the user's own in the same form."""

from functools import cache
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter

from rubgen.errors import UserError
from rubgen.machine.problems import check_plain, nearest, validated
from rubgen.machine.schema_nodes import Path as Place
from rubgen.machine.sentences import toml_text
from rubgen.machine.toml_file import check_kind, named_toml, names_toml, read_toml
from rubgen.sensors.registry import SENSOR_KINDS
from rubgen.sensors.sensor_set import SensorSet

SETS = Path(__file__).parent / "sets"
DEFAULT_SET = "default"
OF_ONE = ("name", "kind")
"""Keys that belong to one sensor and not to its kind."""


def sensor_set_names() -> list[str]:
    """Return the names of the sets of rubgen, sorted."""
    return sorted(path.stem for path in SETS.glob("*.toml"))


@cache
def default_sensor_set() -> SensorSet:
    """Return the sensor set of a recipe that names no set."""
    return load_sensor_set(DEFAULT_SET)


def load_sensor_set(name_or_path: str, folder: Path | None = None) -> SensorSet:
    """Load the set of rubgen with the given name, or the set in a TOML file: a text that ends with .toml is a path.

    A relative path starts from `folder`; None is the current directory. A table `[kinds.<kind>]` in the file has
    default values for all sensors of a kind. Raises UserError with file, key, value and what is allowed where the set
    does not exist or is not valid.
    """
    if name_or_path in sensor_set_names():
        return parse_sensor_set(SETS / f"{name_or_path}.toml")
    if not names_toml(name_or_path):
        hint = nearest(name_or_path, sensor_set_names())
        raise UserError(f"sensors.set = {name_or_path!r:.200}: no such set; {hint}, or the path of a sensor set .toml")
    return parse_sensor_set(named_toml("sensors.set", name_or_path, folder))


def parse_sensor_set(path: Path) -> SensorSet:
    """Read the sensor set in the TOML file at `path`. Raises UserError as `load_sensor_set` does."""
    data = read_toml(path)
    check_kind(path, data, "sensor set")
    check_plain(path, data)
    kinds, listed = _kinds(path, data.pop("kinds", {})), data.get("sensors")
    if not isinstance(listed, list):
        return validated(path, data, TypeAdapter(SensorSet))
    _check_used(path, kinds, listed)
    data["sensors"] = [_completed(path, number, each, kinds) for number, each in enumerate(listed)]

    def place(where: Place) -> Place:
        """Return the place of a value in the file: one from the kind stands in the table of that kind."""
        match where:
            case ("sensors", int(number), str(key), *rest) if key not in listed[number]:
                kind = listed[number]["kind"]
                return ("kinds", kind, key, *rest) if key in kinds.get(kind, {}) else where
        return where

    return validated(path, data, TypeAdapter(SensorSet), place)


def _kinds(path: Path, kinds: Any) -> dict[str, dict[str, Any]]:
    """Return the tables `[kinds.<kind>]`, each with default values for all sensors of a kind."""
    if not isinstance(kinds, dict):
        raise UserError(f"{path}: kinds = {toml_text(kinds):.60}: must be tables; write [kinds.proximity], say")
    for kind, table in kinds.items():
        _check_kind(path, kind, "kinds.")
        if not isinstance(table, dict):
            raise UserError(f"{path}: kinds.{kind} = {toml_text(table):.60}: must be a table; write [kinds.{kind}]")
        for key in OF_ONE:
            if key in table:
                raise UserError(f"{path}: kinds.{kind}.{key}: each sensor has its own; give it in [[sensors]]")
    return kinds


def _check_used(path: Path, kinds: dict[str, dict[str, Any]], listed: list[Any]) -> None:
    """Raise UserError for a table of a kind without sensors."""
    used = [each.get("kind") for each in listed if isinstance(each, dict)]
    for kind in kinds:
        if kind not in used:
            raise UserError(f"{path}: kinds.{kind}: the set has no sensor of this kind; add one or remove the table")


def _completed(path: Path, number: int, sensor: Any, kinds: dict[str, dict[str, Any]]) -> Any:
    """Return a sensor's table with the values of its kind."""
    if not isinstance(sensor, dict):
        return sensor
    if "kind" not in sensor:
        raise UserError(f"{path}: sensors.{number}.kind: this key is missing; add it, one of {', '.join(SENSOR_KINDS)}")
    _check_kind(path, sensor["kind"], f"sensors.{number}.kind = ")
    return {**kinds.get(sensor["kind"], {}), **sensor}


def _check_kind(path: Path, kind: object, where: str) -> None:
    if kind not in SENSOR_KINDS:
        shown = kind if isinstance(kind, str) and kind.isprintable() else toml_text(kind)
        raise UserError(f"{path}: {where}{shown:.60}: unknown kind of sensor; {nearest(str(kind), list(SENSOR_KINDS))}")
