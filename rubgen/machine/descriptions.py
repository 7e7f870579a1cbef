"""Describe the keys of users' files from their JSON schemas: meaning, unit, allowed values, default.

The meaning is written once, by `rubgen.machine.quantities.about` at the field. The rest follows from the field itself.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from pydantic import TypeAdapter

from rubgen.machine.schema_nodes import Node, bounds_in_words, limit

ALLOWED, OWN_DEFAULT = "x-allowed", "x-default"
"""Where the schema of a drawn key says what may be drawn and what a missing key is: a distribution has no bounds."""
UNITS = (
    ("per_s", ""),
    ("m_per_s2", "m/s2"),
    ("n_per_m", "N/m"),
    ("nm_per_rad", "N m/rad"),
    ("kg_per_m3", "kg/m3"),
    ("m2_per_n", "m2/N"),
    ("v_per_m", "V/m"),
    ("kg_m", "kg m"),
    ("pa_s", "Pa s"),
    ("pa", "Pa"),
    ("hz", "Hz"),
    ("rpm", "rev/min"),
    ("deg", "deg"),
    ("kg", "kg"),
    ("ppm", "ppm"),
    ("seconds", "s"),
    ("s", "s"),
    ("m", "m"),
    ("v", "V"),
)
"""The unit by the ending of a key; the first that fits counts. Other keys are pure numbers, or say their unit."""


def unit_of(key: str) -> str:
    """Return the unit of a key by its ending, such as "m" for `clearance_m`; empty where the key has no unit."""
    return next((unit for ending, unit in UNITS if f"_{key}".endswith(f"_{ending}")), "")


@dataclass(frozen=True, kw_only=True)
class Key:
    """One key of a table in a user's file, described for people."""

    name: str
    meaning: str
    unit: str
    allowed: str
    default: str
    """As it stands in TOML; empty where there is none, or where the meaning says what a missing key does."""
    required: bool

    @property
    def text(self) -> str:
        """The whole description, in sentences."""
        facts = (("Unit", self.unit), ("Allowed", self.allowed), ("Default", self.default))
        return " ".join([self.meaning, *(f"{name}: {value}." for name, value in facts if value)])


def keys_of(table: Node, root: Node) -> list[Key]:
    """Return the keys of a table in the order of the schema.

    - table: the JSON schema of the table.
    - root: the whole schema, to whose `$defs` `table` refers.
    """
    needed = table.get("required", ())
    return [_key(name, node, root, required=name in needed) for name, node in table.get("properties", {}).items()]


def complete(schema: dict[str, Any]) -> dict[str, Any]:
    """Return the JSON schema with unit, allowed values and default added to the description of each property."""
    completed: dict[str, Any] = _completed(schema, schema)
    return completed


def draws(quantity: Any, default: object = None) -> Callable[[dict[str, Any]], None]:
    """Return a function that adds range and default of a drawn quantity to the JSON schema of a distribution, in place.

    It adds the keys ALLOWED and OWN_DEFAULT, and is made for pydantic's `json_schema_extra`.

    - quantity: the annotated type of the drawn value.
    - default: the value where the key is missing. With None no default is shown.
    """

    def add(schema: dict[str, Any]) -> None:
        root = TypeAdapter(quantity).json_schema()
        schema[ALLOWED] = _allowed(root, root)
        schema[OWN_DEFAULT] = default

    return add


def _completed(node: Any, root: Node) -> Any:
    if isinstance(node, list):
        return [_completed(each, root) for each in node]
    if not isinstance(node, dict):
        return node
    copy = {key: _completed(each, root) for key, each in node.items() if key not in (ALLOWED, OWN_DEFAULT)}
    for key in keys_of(node, root) if isinstance(node.get("properties"), dict) else ():
        copy["properties"][key.name]["description"] = key.text
    return copy


def _key(name: str, node: Node, root: Node, *, required: bool) -> Key:
    return Key(
        name=name,
        meaning=node.get("description", ""),
        unit=unit_of(name),
        allowed=_allowed(node, root),
        default="" if required or "const" in node else _default(node.get(OWN_DEFAULT, node.get("default"))),
        required=required,
    )


def _allowed(node: Node, root: Node) -> str:
    """Say what a value may be: a range, some words, or a list; empty where its type says enough."""
    if ALLOWED in node:
        return str(node[ALLOWED])
    if node.get("type") == "array":
        places = node.get("prefixItems")
        each = _allowed(places[0] if places else node.get("items", {}), root)
        return f"each {each.removeprefix('each ')}" if each else ""
    words = [branch for branch in _branches(node, root) if branch]
    return " or ".join(dict.fromkeys(words))


def _branches(node: Node, root: Node) -> Iterator[str]:
    if "anyOf" in node:
        for each in node["anyOf"]:
            yield _allowed(each, root)
    yield bounds_in_words([node])
    if "enum" in node:
        yield ", ".join(_default(word) for word in node["enum"])
    if "const" in node and "default" not in node:
        yield _default(node["const"])
    if node.get("type") == "boolean":
        yield "true, false"


def _default(value: object) -> str:
    match value:
        case bool():
            return str(value).lower()
        case int() | float():
            return limit(value).replace(",", "")
        case str():
            return f'"{value}"' if value else ""
        case list() if value:
            return f"[{', '.join(map(_default, value))}]"
        case Mapping() | None | _:
            return ""
